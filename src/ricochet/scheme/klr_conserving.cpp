#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

namespace {

/// The energy-conserving scheme of the source's section 4, with the contact condition on velocities:
///   M (Uⁿ⁺¹−2Uⁿ+Uⁿ⁻¹)/h² + C Vⁿ + K (Uⁿ⁺¹+2Uⁿ+Uⁿ⁻¹)/4 = Lⁿ + Gᵀ rⁿ,   Vⁿ = (Uⁿ⁺¹−Uⁿ⁻¹)/2h,
///   gⁿ > 0 ⇒ r = 0,   gⁿ ≤ 0 ⇒ 0 ≤ r ⟂ G Vⁿ ≥ 0.
/// Unknown x = Uⁿ⁺¹, base 2Uⁿ−Uⁿ⁻¹, so that M(…)/h² = M δ/h² and K(…)/4 = K Uⁿ + K δ/4.
/// J((Uⁿ+Uⁿ⁺¹)/2, (Uⁿ⁺¹−Uⁿ)/h) is conserved exactly, since rⁿ does no work on (Uⁿ⁺¹−Uⁿ⁻¹)/2.
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

  /// U¹ = U⁰ + hV⁰ + (h²/2)A⁰: the source asks for U¹ = U⁰ + hV⁰ + h z(h) with z → 0.
  void start(const SemidiscreteProblem& problem, State& state) override {
    if (problem.has_singular_mass()) {
      // Massless dofs would follow K_cc (Uⁿ⁺¹+2Uⁿ+Uⁿ⁻¹)/4 = …, whose characteristic polynomial (z+1)² has a double
      // root: they oscillate from step to step with an amplitude that grows linearly, and the half-step energy does not
      // see it.
      throw Error(
          ErrorKind::invalid_input,
          "scheme \"klr-conserving\" needs inertia on the contact nodes: without it they oscillate more and more; "
          "set mass.type = \"consistent\" (or \"lumped\"), or use scheme \"newmark\" with this mass");
    }
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
    problem.internal_force->evaluate(now_, force_);
    problem.loads.total(time, stage.right_hand_side);
    stage.right_hand_side -= force_;
    // C Vⁿ = C (Uⁿ−Uⁿ⁻¹)/h + C δ/2h.
    if (problem.has_damping()) stage.right_hand_side.noalias() -= problem.damping * difference * (1.0 / h);
    problem.supports.values(time + h, supported_);
    stage.prescribed.resize(problem.supports.size());
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      stage.prescribed[i] = supported_[i] - (now_[dof] + difference[dof]);
    }
    problem.gaps(now_, gap_);
    stage.gap_offset.noalias() = problem.contact.gap_operator * difference;
    stage.gap_offset *= 1.0 / h;
    stage.gap_factor = 0.5 / h;
    stage.gap_offset_rounding.resize(gap_.size());
    stage.eligible.resize(static_cast<std::size_t>(gap_.size()));
    const double unit = 4.0 * std::numeric_limits<double>::epsilon() / h;
    for (Index i = 0; i < gap_.size(); ++i) {
      stage.eligible[static_cast<std::size_t>(i)] = gap_[i] <= problem.contact.gap_rounding[i] ? 1 : 0;
      const Index first = problem.contact.nodes[static_cast<std::size_t>(i)] * problem.dimension;
      stage.gap_offset_rounding[i] = unit * (now_.segment(first, problem.dimension).lpNorm<1>() +
                                             before.segment(first, problem.dimension).lpNorm<1>());
    }
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
    state.forces.normal_reaction = solution.normal_reaction;
    state.forces.support_reaction = solution.support_reaction;
    if (problem.loads.varies()) problem.loads.varying(state.time + h, state.forces.varying_load);
    if (problem.has_damping()) state.forces.damping_force.noalias() = problem.damping * state.velocity;
  }

  void energy_state(const State& state, Vector& displacement, Vector& velocity) const override {
    const Vector& ahead = state.memory.at("increment_ahead");
    displacement = state.displacement + 0.5 * ahead;
    velocity = ahead / step();
  }

 private:
  Vector now_, force_, supported_, gap_;
};

}  // namespace

std::unique_ptr<Scheme> make_klr_conserving(const SchemeParameters& parameters) {
  return std::make_unique<KlrConserving>(parameters);
}

}  // namespace ricochet
