#include "ricochet/scheme/integration_error.hpp"
#include "ricochet/scheme/newmark_keys.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Newmark's scheme with contact at the end of the step (the source's section 5 with an equivalent mass):
///   M A₁ + C V₁ + K U₁ = L₁ + Gᵀ r_N − B_Tᵀ r_T,   0 ≤ r_N ⟂ g(U₁) ≥ 0,   friction on the slip rate B_T (U₁−U₀)/h,
///   U₁ = U₀ + hV₀ + h²[(½−β)A₀ + βA₁],   V₁ = V₀ + h[(1−γ)A₀ + γA₁]   (textbook β and γ).
/// Unknown x = U₁, base Ũ = U₀ + hV₀ + h²(½−β)A₀, so that A₁ = δ/(βh²).
///
/// Energy: in a step J + ½h²(β−γ/2)AᵀMA changes by ΔUᵀ[(1−γ)F₀+γF₁], with F the forces outside J, less
///   (γ−½)ΔUᵀKΔU + ½h²(β−γ/2)(2γ−1)ΔAᵀMΔA
/// (S. Krenk, Comput. Methods Appl. Mech. Engrg. 195 (2006) 6110–6124). J is the energy ½VᵀMV + W − LᵀU with constant
/// loads. For a nonlinear internal force f, the integration error ΔW − ΔU·[(1−γ)f₀+γf₁] of the elastic energy W
/// replaces −(γ−½)ΔUᵀKΔU in this change (integration_error.hpp).
///
/// On massless dofs A and V are not state variables: A = 0, V = ΔU/h. Damping then acts on ΔU/h for all dofs, because a
/// mixture of the two velocities would make the operator unsymmetric.
class Newmark final : public Scheme {
 public:
  Newmark(double step, double beta, double gamma)
      : Scheme(step, {.work_rule = {1.0 - gamma, gamma},
                      .supports_step_changes = true,
                      .supports_nonlinear_force = true,
                      .suits_singular_mass = true,
                      // A node that friction holds is one whose displacement is prescribed: under the trapezoidal rule
                      // it keeps ±V.
                      .stuck_nodes_alternate = newmark_jump_response({beta, gamma}) != JumpResponse::damped,
                      .jump_response = newmark_jump_response({beta, gamma})}),
        beta_(beta),
        gamma_(gamma) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    return {{alpha(), 1.0, damping_factor(problem)}};
  }
  /// Numbers of the random cases of docs/energy.md.
  [[nodiscard]] ProblemTraits traits_for(const SemidiscreteProblem& problem) const override {
    if (!problem.has_singular_mass()) {
      return {
          .long_steps = {
              .consequence =
                  "its contact and friction forces can create energy: with beta = 1/4, gamma = 1/2 and inertia at "
                  "contact nodes more than 1 % of the total was created in half of the random cases, with steps of any "
                  "length",
              .shorter_steps_help = false}};
    }
    return {
        .long_steps = {
            .consequence =
                "its contact and friction forces can create energy: with beta = 1/4, gamma = 1/2 more than 1 % of the "
                "total was created in one of eleven random cases at one to three crossings, in half of them at three "
                "to ten, and in nine of ten beyond thirty"}};
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step();
    error_.begin(problem, state);
    predicted_ = h * state.velocity + (h * h * (0.5 - beta_)) * state.acceleration;
    base_ = state.displacement + predicted_;
    Stage& stage = stages.stage(0);
    if (problem.has_damping()) compute_damping_velocity(problem, state);
    equations_.balance(problem, state.time + h, base_, velocity_, stage);
    equations_.prescribe_from(problem, state.time + h, base_, stage);
    require_no_penetration(problem, base_, state.time + h, stage);
    equations_.require_friction_over_step(problem, state, predicted_, h, stage);

    const StageSolution& solution = stages.solve(0);
    increment = predicted_ + solution.increment;
    acceleration_ = alpha() * solution.increment;
    for (const Index dof : problem.massless_dofs) acceleration_[dof] = 0.0;
    compute_dissipation(problem, state, increment);
    state.displacement += increment;
    integration_error_ = problem.internal_force->is_linear() ? 0.0 : error_.end(problem, increment, gamma_, state);
    state.velocity += h * ((1.0 - gamma_) * state.acceleration + gamma_ * acceleration_);
    state.acceleration = acceleration_;
    follow_without_inertia(problem, increment, h, state);
    if (problem.has_damping()) velocity_ += damping_factor(problem) * solution.increment;
    equations_.store_forces(problem, stage, solution, h, velocity_, 1.0, state);
  }

  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override {
    const double factor = 0.5 * step() * step() * (beta_ - 0.5 * gamma_);
    if (factor == 0.0) return 0.0;
    return factor * problem.mass.quadratic_form(state.acceleration);
  }

  [[nodiscard]] LastStep last_step() const override {
    return {.corrections = {.numerical_dissipation = dissipation_, .integration_error = integration_error_}};
  }

 private:
  [[nodiscard]] double alpha() const { return 1.0 / (beta_ * step() * step()); }
  [[nodiscard]] double damping_factor(const SemidiscreteProblem& problem) const {
    return problem.has_singular_mass() ? 1.0 / step() : gamma_ * step() * alpha();
  }

  /// Computes the velocity that damping acts on, at δ = 0.
  void compute_damping_velocity(const SemidiscreteProblem& problem, const State& state) {
    if (problem.has_singular_mass()) {
      velocity_ = predicted_ / step();
    } else {
      velocity_ = state.velocity + (step() * (1.0 - gamma_)) * state.acceleration;
    }
  }

  void compute_dissipation(const SemidiscreteProblem& problem, const State& state, const Vector& increment) {
    dissipation_ = 0.0;
    if (gamma_ == 0.5) return;
    if (problem.internal_force->is_linear())
      dissipation_ = (gamma_ - 0.5) * elastic_product(problem, increment, increment, force_);
    difference_ = acceleration_ - state.acceleration;
    dissipation_ += 0.5 * step() * step() * (beta_ - 0.5 * gamma_) * (2.0 * gamma_ - 1.0) *
                    problem.mass.quadratic_form(difference_);
  }

  double beta_, gamma_;
  double dissipation_ = 0.0, integration_error_ = 0.0;
  Vector base_, predicted_, acceleration_, velocity_, difference_, force_;
  StepEquations equations_;
  IntegrationError error_;
};

}  // namespace

SchemeRegistration newmark_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    const auto [beta, gamma] = newmark_parameters(parameters);
    return std::make_unique<Newmark>(step, beta, gamma);
  };
  return {"newmark", make, newmark_keys(), {}, check_newmark};
}

}  // namespace ricochet
