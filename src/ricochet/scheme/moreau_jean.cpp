#include "ricochet/scheme/requirements.hpp"
#include "ricochet/scheme/restitution_key.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// θ scheme of M. Jean and J. J. Moreau with contact on velocities and Newton's restitution e (M. Jean, Comput. Methods
/// Appl. Mech. Engrg. 177 (1999) 235–257):
///   M (V₁−V₀)/h + C V_θ + K U_θ = L_θ + Gᵀ r_N − B_Tᵀ r_T,   V_θ = (1−θ)V₀+θV₁ = (U₁−U₀)/h,   U_θ = (1−θ)U₀+θU₁,
///   g(U₀ + (h/2)V₀) > 0 ⇒ r_N = 0,   else 0 ≤ r_N ⟂ G V₁ + e G V₀ ≥ 0,
/// friction on the slip rate B_T V₁, or on B_T V_θ (V. Acary, Z. Angew. Math. Mech. 96 (2016) 585–603); velocities are
/// relative to the obstacle. h r are impulses. Unknown x = U₁, base U₀ + hV₀, so that δ = θh(V₁−V₀). In a step J
/// changes by h (r_N·G V_θ − r_T·B_T V_θ) − (θ−½)(|ΔV|²_M + |ΔU|²_K). The friction term has a sign if friction acts on
/// V_θ; the contact term is (1−θ(1+e)) h r_N·G V₀, and points that separate have G V₀ > 0: contact can create energy.
/// Positions are never corrected: points keep the penetration, of up to their motion in a step, at which an impact
/// stopped them.
class MoreauJean final : public Scheme {
 public:
  MoreauJean(double step, double theta, double restitution, bool slip_at_end)
      : Scheme(step, {.force_instant = theta - 1.0,
                      .acting_instant = -0.5,
                      .supports_step_changes = true,
                      // V₁ = V₀ + (ΔU/h − V₀)/θ
                      .jump_response = theta > 0.5 ? JumpResponse::damped : JumpResponse::undamped}),
        theta_(theta),
        restitution_(restitution),
        slip_at_end_(slip_at_end) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    const double h = step();
    return {{1.0 / (theta_ * h * h), theta_, 1.0 / h}};
  }
  [[nodiscard]] LastStep last_step() const override { return {.corrections = {.numerical_dissipation = dissipation_}}; }

  void analyse(const SemidiscreteProblem& problem) override {
    require_contact_inertia(problem, "moreau-jean", "its impulses change their velocities");
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step(), instant = state.time + theta_ * h;
    Stage& stage = stages.stage(0);
    work_displacement_ = state.displacement + (theta_ * h) * state.velocity;
    equations_.balance(problem, instant, work_displacement_, state.velocity, stage);
    const auto to_end = [&](Index dof, double end) { return end - state.displacement[dof] - h * state.velocity[dof]; };
    equations_.prescribe(problem, state.time + h, to_end, stage);
    work_displacement_ = state.displacement + (0.5 * h) * state.velocity;
    evaluate_obstacle_velocity(problem, work_displacement_, {state.time + 0.5 * h, h}, stage);
    equations_.require_impact_law(problem, work_displacement_, state.time + 0.5 * h, state.velocity, state.velocity,
                                  1.0 / (theta_ * h), restitution_, h, stage);
    equations_.require_friction_beside_rates(problem, state.velocity, 1.0 / ((slip_at_end_ ? theta_ : 1.0) * h), stage);

    const StageSolution& solution = stages.solve(0);
    increment = h * state.velocity + solution.increment;
    rate_ = solution.increment / (theta_ * h);  // V₁ − V₀
    compute_dissipation(problem, increment);
    state.displacement += increment;
    state.velocity += rate_;
    state.acceleration = rate_ / h;
    equations_.store_forces(problem, stage, solution, h, increment, 1.0 / h, state);
  }

 private:
  void compute_dissipation(const SemidiscreteProblem& problem, const Vector& increment) {
    dissipation_ = 0.0;
    if (theta_ == 0.5) return;
    dissipation_ = (theta_ - 0.5) * (problem.mass.quadratic_form(rate_) +
                                     elastic_product(problem, increment, increment, work_displacement_));
  }

  double theta_, restitution_;
  bool slip_at_end_;
  double dissipation_ = 0.0;
  Vector work_displacement_, rate_;
  StepEquations equations_;
};

}  // namespace

SchemeRegistration moreau_jean_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<MoreauJean>(step, parameters.number("theta"), parameters.number("restitution"),
                                        parameters.text("slip") == "end");
  };
  return {
      "moreau-jean",
      make,
      {number_key("theta", "1", {.default_value = "0.5", .range = {.at_least = 0.5, .at_most = 1.0}},
                  "Instant within the step at which forces are evaluated: 1/2 is the midpoint, larger values damp."),
       restitution_key(),
       choice_key("slip", {"end", "theta"}, {.default_value = "end"},
                  "Instant of the slip rate in Coulomb's law; with \"theta\" friction never creates energy.")}};
}

}  // namespace ricochet
