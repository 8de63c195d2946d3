#include "ricochet/scheme/integration_error.hpp"
#include "ricochet/scheme/requirements.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Midpoint scheme of the source's section 3, with the contact condition at the midpoint:
///   M (V₁−V₀)/h + C V_½ + K U_½ = L_½ + Gᵀ r_N − B_Tᵀ r_T,   U_½ = (U₀+U₁)/2,   V_½ = (V₀+V₁)/2 = (U₁−U₀)/h,
///   0 ≤ r_N ⟂ g(U_½) ≥ 0,   friction on the slip rate B_T V_½.
/// Unknown x = U_½, base U₀ + (h/2)V₀, so that M (V₁−V₀)/h = (4/h²) M δ.
/// Away from contact it conserves energy (at finite strain up to ΔW − ΔU·f(U_½), f the internal force:
/// integration_error.hpp); with contact its energy changes by (U₁−U₀)ᵀGᵀr of either sign, which multiplies it by
/// hundreds and does not vanish as h → 0: the scheme is included to show this.
class Midpoint final : public Scheme {
 public:
  explicit Midpoint(double step)
      : Scheme(step, {.force_instant = -0.5,
                      .supports_step_changes = true,
                      .supports_nonlinear_force = true,
                      .conserves_moments_at_finite_strain = true,
                      .jump_response = JumpResponse::undamped}) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    const double h = step();
    return {{4.0 / (h * h), 1.0, 2.0 / h, StageDofs::all}};
  }

  void analyse(const SemidiscreteProblem& problem) override {
    require_contact_inertia(problem, "midpoint", "without it they flip from step to step");
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step(), middle = state.time + 0.5 * h;
    base_ = state.displacement + (0.5 * h) * state.velocity;
    Stage& stage = stages.stage(0);
    // V_½ = V₀ + (2/h) δ, also without inertia: V is ΔU/h there, and 2(x − U₀)/h = ΔU/h.
    equations_.balance(problem, middle, base_, state.velocity, stage);
    const auto half_way = [&](Index dof, double end) { return 0.5 * (state.displacement[dof] + end) - base_[dof]; };
    equations_.prescribe(problem, state.time + h, half_way, stage);
    require_no_penetration(problem, base_, middle, stage);
    evaluate_obstacle_velocity(problem, base_, {middle, h, 1.0}, stage);
    require_friction(problem, state.velocity, 2.0 / h, stage);

    const StageSolution& solution = stages.solve(0);
    increment = h * state.velocity + 2.0 * solution.increment;  // 2 (x − U₀)
    integration_error_ = error_.of_step(problem, state, increment);
    state.displacement += increment;
    state.velocity += (4.0 / h) * solution.increment;           // 2 (U₁−U₀)/h − V₀
    state.acceleration = (4.0 / (h * h)) * solution.increment;  // (V₁−V₀)/h
    follow_without_inertia(problem, increment, h, state);
    equations_.store_forces(problem, stage, solution, h, increment, 1.0 / h, state);
  }

  [[nodiscard]] LastStep last_step() const override {
    return {.corrections = {.integration_error = integration_error_}};
  }

 private:
  Vector base_;
  double integration_error_ = 0.0;
  StepEquations equations_;
  MidpointIntegrationError error_;
};

}  // namespace

SchemeRegistration midpoint_scheme() {
  return {"midpoint", [](double step, const Parameters&) { return std::make_unique<Midpoint>(step); }};
}

}  // namespace ricochet
