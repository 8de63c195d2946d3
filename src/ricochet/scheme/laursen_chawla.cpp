#include "ricochet/scheme/requirements.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Persistency condition of T. A. Laursen and V. Chawla (Int. J. Numer. Meth. Engng. 40 (1997) 863–886) in the midpoint
/// scheme: a point that touches at the start of the step does not approach its obstacle over the step, the others carry
/// no force,
///   M (V₁−V₀)/h + C V_½ + K U_½ = L_½ + Gᵀ r_N − B_Tᵀ r_T,   V_½ = (V₀+V₁)/2 = (U₁−U₀)/h,
///   g(U₀) > 0 ⇒ r_N = 0,   g(U₀) ≤ 0 ⇒ 0 ≤ r_N ⟂ (g(U₁) − g(U₀))/h ≥ 0,   friction on the slip rate B_T V_½.
/// Unknown x = U_½, base U₀ + (h/2)V₀, so that M (V₁−V₀)/h = (4/h²) M δ. Contact forces do no work: J is conserved to
/// rounding, but points penetrate by up to their motion in a step, and contact forces oscillate.
class LaursenChawla final : public Scheme {
 public:
  explicit LaursenChawla(double step)
      : Scheme(step, {.force_instant = -0.5, .supports_step_changes = true, .jump_response = JumpResponse::undamped}) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    const double h = step();
    return {{4.0 / (h * h), 1.0, 2.0 / h}};
  }

  void analyse(const SemidiscreteProblem& problem) override {
    require_contact_inertia(problem, "laursen-chawla", "without it they flip from step to step");
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step(), middle = state.time + 0.5 * h;
    base_ = state.displacement + (0.5 * h) * state.velocity;
    Stage& stage = stages.stage(0);
    equations_.balance(problem, middle, base_, state.velocity, stage);
    const auto half_way = [&](Index dof, double end) { return 0.5 * (state.displacement[dof] + end) - base_[dof]; };
    equations_.prescribe(problem, state.time + h, half_way, stage);
    evaluate_obstacle_velocity(problem, base_, {middle, h}, stage);
    require_no_approach(problem, state.displacement, state.time, state.velocity, 2.0 / h, stage.obstacle, h, stage);
    equations_.require_friction_beside_rates(problem, state.velocity, 2.0 / h, stage);

    const StageSolution& solution = stages.solve(0);
    increment = h * state.velocity + 2.0 * solution.increment;
    state.displacement += increment;
    state.velocity += (4.0 / h) * solution.increment;
    state.acceleration = (4.0 / (h * h)) * solution.increment;  // (V₁−V₀)/h
    equations_.store_forces(problem, stage, solution, h, increment, 1.0 / h, state);
  }

 private:
  Vector base_;
  StepEquations equations_;
};

}  // namespace

SchemeRegistration laursen_chawla_scheme() {
  return {"laursen-chawla", [](double step, const Parameters&) { return std::make_unique<LaursenChawla>(step); }};
}

}  // namespace ricochet
