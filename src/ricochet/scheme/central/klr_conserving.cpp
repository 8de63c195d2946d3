#include "ricochet/base/error.hpp"
#include "ricochet/problem/contact_conditions.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"

namespace ricochet {

namespace {

/// The energy-conserving scheme of the source's section 4, with the contact condition on velocities:
///   M (Uⁿ⁺¹−2Uⁿ+Uⁿ⁻¹)/h² + C Vⁿ + K (Uⁿ⁺¹+2Uⁿ+Uⁿ⁻¹)/4 = Lⁿ + Gᵀ r_Nⁿ − B_Tᵀ r_Tⁿ,
///   Vⁿ = (Uⁿ⁺¹−Uⁿ⁻¹)/2h,   gⁿ > 0 ⇒ r_N = 0,   gⁿ ≤ 0 ⇒ 0 ≤ r_N ⟂ G Vⁿ ≥ 0,   friction on the slip rate B_T Vⁿ.
/// Unknown x = Uⁿ⁺¹, base 2Uⁿ−Uⁿ⁻¹, so that M(…)/h² = M δ/h² and K(…)/4 = K Uⁿ + K δ/4.
/// J((Uⁿ+Uⁿ⁺¹)/2, (Uⁿ⁺¹−Uⁿ)/h) is conserved exactly, since r_Nⁿ does no work on (Uⁿ⁺¹−Uⁿ⁻¹)/2;
/// friction takes h r_T·w ≥ 0 from it.
/// What is remembered is Uⁿ⁺¹−Uⁿ, not Uⁿ⁺¹: small steps lose no digits.
/// A row of the history at tₙ has Uⁿ, Vⁿ and rⁿ, and the energy at n+½.
class KlrConserving final : public Scheme {
 public:
  using Scheme::Scheme;

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    const double h = step();
    return {{1.0 / (h * h), 0.25, 0.5 / h}};
  }
  [[nodiscard]] double energy_instant() const override { return 0.5; }

  void analyse(const SemidiscreteProblem& problem) override {
    if (problem.has_singular_mass()) {
      // Massless dofs would follow K_cc (Uⁿ⁺¹+2Uⁿ+Uⁿ⁻¹)/4 = …, whose characteristic polynomial (z+1)² has a double
      // root: they oscillate from step to step with an amplitude that grows linearly, and the half-step energy does not
      // see it.
      throw Error(
          ErrorKind::invalid_input,
          "scheme \"klr-conserving\" needs inertia on the contact nodes: without it they oscillate more and more; "
          "set mass.type = \"consistent\" (or \"lumped\"), or use scheme \"reduced-kane\" with this mass");
    }
  }

  /// U¹ = U⁰ + hV⁰ + (h²/2)A⁰: the source asks for U¹ = U⁰ + hV⁰ + h z(h) with z → 0.
  void start(const SemidiscreteProblem& problem, State& state) override {
    const double h = step();
    Vector& ahead = state.memory["increment_ahead"];
    ahead = h * state.velocity + (0.5 * h * h) * state.acceleration;
    const auto to_first = [&](Index dof, double first) { return ahead[dof] = first - state.displacement[dof]; };
    equations_.prescribe(problem, h, to_first, supported_);
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step(), time = state.time + h;
    Vector& ahead = state.memory.at("increment_ahead");  // Uⁿ − Uⁿ⁻¹
    now_ = state.displacement + ahead;                   // Uⁿ; the state is that of n−1
    velocity_ = ahead / h;
    Stage& stage = stages.stage(0);
    equations_.balance(problem, time, now_, velocity_, stage);  // Vⁿ = (Uⁿ−Uⁿ⁻¹)/h + δ/2h
    const auto to_next = [&](Index dof, double next) { return next - (now_[dof] + ahead[dof]); };
    equations_.prescribe(problem, time + h, to_next, stage);
    equations_.observe_obstacles(problem, time, now_);
    require_no_approach(problem, now_, time, velocity_, equations_.obstacle_velocity(), h, stage);
    stage.gap_factor = 0.5 / h;
    equations_.require_friction(problem, velocity_, 0.5 / h, stage);
    if (stage.slip_offset.size() > 0) stage.slip_offset_rounding = stage.gap_offset_rounding;

    const StageSolution& solution = stages.solve(0);
    state.displacement += ahead;
    increment = ahead + 0.5 * solution.increment;  // (Uⁿ⁺¹−Uⁿ⁻¹)/2
    ahead += solution.increment;
    state.velocity = increment / h;
    state.acceleration = solution.increment / (h * h);
    equations_.take_forces(problem, stage, solution, h, state.velocity, 1.0, state);
  }

  void energy_state(const State& state, Vector& displacement, Vector& velocity) const override {
    const Vector& ahead = state.memory.at("increment_ahead");
    displacement = state.displacement + 0.5 * ahead;
    velocity = ahead / step();
  }

 private:
  Vector now_, velocity_, supported_;
  StepEquations equations_;
};

}  // namespace

SchemeRegistration klr_conserving_scheme() {
  return {"klr-conserving", [](double step, const Parameters&) { return std::make_unique<KlrConserving>(step); }};
}

}  // namespace ricochet
