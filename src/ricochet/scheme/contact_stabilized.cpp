#include "ricochet/scheme/requirements.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Contact-stabilized Newmark scheme (P. Deuflhard, R. Krause, S. Ertel, Int. J. Numer. Meth. Engng. 73 (2008)
/// 1274–1290): the free flight is projected onto the admissible displacements in the norm of the mass, then the
/// trapezoidal rule is applied with the contact forces wholly at the end of the step:
///   M (Û − U₀ − hV₀) = Gᵀμ,   0 ≤ μ ⟂ g(Û) ≥ 0;
///   (2/h²) M (U₁ − Û) + C (U₁−U₀)/h + K (U₀+U₁)/2 = L_½ + Gᵀ r_N − B_Tᵀ r_T,   0 ≤ r_N ⟂ g(U₁) ≥ 0,
///   friction on B_T (U₁−U₀)/h;   V₁ = V₀ + (2/h)(U₁ − Û).
/// The second stage depends on the first. In a step J changes by ΔUᵀ(Gᵀr_N − …) − (2/h²)(Û−U₀−hV₀)ᵀM(U₁−Û); without
/// friction, and apart from the work of supports, by −r_N·g₀ − (2/h²) μ·g₁ ≤ 0 if gaps are linear: no step, however
/// long, creates energy there. r_N acts along normals of the step, so that its term is ≤ 0 on spheres as well; the term
/// of μ is smaller in hollows (concave gaps) and larger on balls (convex ones), by up to (2/h²) μ |U₁−Û|²/2R.
class ContactStabilized final : public Scheme {
 public:
  explicit ContactStabilized(double step)
      : Scheme(step, {.force_instant = -0.5, .supports_step_changes = true, .jump_response = JumpResponse::undamped}) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    const double h = step();
    return {{1.0, 0.0, 0.0}, {2.0 / (h * h), 0.5, 1.0 / h}};
  }
  [[nodiscard]] LastStep last_step() const override {
    return {.corrections = {.support_work = support_work_, .numerical_dissipation = dissipation_}};
  }

  void analyse(const SemidiscreteProblem& problem) override {
    require_contact_inertia(problem, "contact-stabilized", "it projects in the norm of the mass");
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step(), end = state.time + h;
    base_ = state.displacement + h * state.velocity;
    Stage& projection = unloaded_stage(problem, 0, stages);
    require_no_penetration(problem, base_, end, projection);
    const StageSolution& projected = stages.solve(0);
    const Vector& shift = projected.increment;  // Û − U₀ − hV₀

    Stage& stage = stages.stage(1);
    flight_ = h * state.velocity + shift;  // Û − U₀
    base_ += shift;
    middle_ = state.displacement + 0.5 * flight_;
    if (problem.has_damping()) rate_ = flight_ / h;
    equations_.balance(problem, state.time + 0.5 * h, middle_, rate_, stage);
    equations_.prescribe_from(problem, end, base_, stage);
    const StepStart start{state.displacement, state.time};
    require_no_penetration(problem, base_, end, stage, &start);
    equations_.require_friction_over_step(problem, state, flight_, h, stage);
    const StageSolution& solution = stages.solve(1);

    problem.mass.multiply(solution.increment, momentum_);
    // Reactions of supports during the projection.
    support_work_ = -2.0 / (h * h) * problem.supports.work(projected.support_reaction, solution.increment);
    dissipation_ = 2.0 / (h * h) * shift.dot(momentum_) + support_work_;
    increment = flight_ + solution.increment;
    state.displacement += increment;
    state.velocity += (2.0 / h) * solution.increment;
    state.acceleration = (2.0 / (h * h)) * solution.increment;  // (V₁−V₀)/h
    equations_.store_forces(problem, stage, solution, h, increment, 1.0 / h, state);
  }

 private:
  double dissipation_ = 0.0, support_work_ = 0.0;
  Vector base_, flight_, middle_, rate_, momentum_;
  StepEquations equations_;
};

}  // namespace

SchemeRegistration contact_stabilized_scheme() {
  return {"contact-stabilized",
          [](double step, const Parameters&) { return std::make_unique<ContactStabilized>(step); }};
}

}  // namespace ricochet
