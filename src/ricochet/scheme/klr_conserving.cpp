#include "ricochet/base/error.hpp"
#include "ricochet/scheme/contact_conditions.hpp"
#include "ricochet/scheme/scheme.hpp"

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
          "set mass.type = \"consistent\" (or \"lumped\"), or use scheme \"newmark\" with this mass");
    }
  }

  /// U¹ = U⁰ + hV⁰ + (h²/2)A⁰: the source asks for U¹ = U⁰ + hV⁰ + h z(h) with z → 0.
  void start(const SemidiscreteProblem& problem, State& state) override {
    const double h = step();
    Vector& ahead = state.memory["increment_ahead"];
    ahead = h * state.velocity + (0.5 * h * h) * state.acceleration;
    problem.supports.values(h, supported_);
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      ahead[dof] = supported_[i] - state.displacement[dof];
    }
  }

  void prepare(const SemidiscreteProblem& problem, const State& state, int, Stage& stage) override {
    const double h = step();
    const Vector& before = state.displacement;                      // the source's Uⁿ⁻¹
    const Vector& difference = state.memory.at("increment_ahead");  // Uⁿ − Uⁿ⁻¹
    const double time = state.time + h;
    now_ = before + difference;  // Uⁿ
    velocity_ = difference / h;
    problem.internal_force->evaluate(now_, force_);
    problem.loads.total(time, stage.right_hand_side);
    stage.right_hand_side -= force_;
    // C Vⁿ = C (Uⁿ−Uⁿ⁻¹)/h + C δ/2h.
    if (problem.has_damping()) stage.right_hand_side.noalias() -= problem.damping * velocity_;
    problem.supports.values(time + h, supported_);
    stage.prescribed.resize(problem.supports.size());
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      stage.prescribed[i] = supported_[i] - (now_[dof] + difference[dof]);
    }
    require_contact(problem, time, stage);
  }

  void finish(const SemidiscreteProblem& problem, const std::vector<StageSolution>& solutions, State& state,
              Vector& increment) override {
    const double h = step();
    const StageSolution& solution = solutions.front();
    Vector& ahead = state.memory.at("increment_ahead");
    state.displacement += ahead;
    increment = ahead + 0.5 * solution.increment;  // (Uⁿ⁺¹−Uⁿ⁻¹)/2
    ahead += solution.increment;
    state.velocity = increment / h;
    state.acceleration = solution.increment / (h * h);
    for (const Index dof : problem.massless_dofs) state.acceleration[dof] = 0.0;
    take_contact(solution, obstacle_velocity_, h, state);
    if (problem.loads.varies()) problem.loads.varying(state.time + h, state.forces.varying_load);
    if (problem.has_damping()) state.forces.damping_force.noalias() = problem.damping * state.velocity;
  }

  void energy_state(const State& state, Vector& displacement, Vector& velocity) const override {
    const Vector& ahead = state.memory.at("increment_ahead");
    displacement = state.displacement + 0.5 * ahead;
    velocity = ahead / step();
  }

 private:
  /// On velocities: those at δ = 0 are (Uⁿ−Uⁿ⁻¹)/h.
  void require_contact(const SemidiscreteProblem& problem, double time, Stage& stage) {
    const double h = step();
    problem.obstacle_velocity(now_, time, obstacle_velocity_);
    problem.gaps(now_, time, gap_);
    stage.gap_offset.noalias() = problem.contact.gap_operator * velocity_;
    if (obstacle_velocity_.normal.size() > 0) stage.gap_offset -= obstacle_velocity_.normal;
    stage.gap_factor = 0.5 / h;
    // The velocity is a difference of displacements.
    problem.trace_rounding(now_, stage.gap_offset_rounding);
    problem.trace_rounding(velocity_, velocity_rounding_);
    stage.gap_offset_rounding = stage.gap_offset_rounding / h + velocity_rounding_;
    stage.eligible.resize(static_cast<std::size_t>(gap_.size()));
    for (Index i = 0; i < gap_.size(); ++i) {
      stage.eligible[static_cast<std::size_t>(i)] = gap_[i] <= problem.contact.gap_rounding[i] ? 1 : 0;
    }
    require_friction(problem, velocity_, obstacle_velocity_, 0.5 / h, stage);
    if (stage.slip_offset.size() > 0) stage.slip_offset_rounding = stage.gap_offset_rounding;
  }

  Vector now_, force_, supported_, gap_, velocity_, velocity_rounding_;
  ObstacleMotion obstacle_velocity_;
};

}  // namespace

std::unique_ptr<Scheme> make_klr_conserving(const SchemeParameters& parameters) {
  return std::make_unique<KlrConserving>(parameters);
}

}  // namespace ricochet
