#include "ricochet/scheme/kane.hpp"
#include "ricochet/scheme/response/contact_response.hpp"
#include "ricochet/scheme/response/restoring_impulses.hpp"

namespace ricochet {

namespace {

/// Velocity update of T. A. Laursen and G. R. Love (Int. J. Numer. Meth. Engng. 53 (2002) 245–274) on Kane's scheme:
/// positions are Kane's, and impulses p ≥ 0 of the obstacle, at points that press at the end of a step which they began
/// apart from it, return the energy that their forces took,
///   V₁ = V₁* + M⁻¹Gᵀp, p_i [(G V₁*)_i + ½(W p)_i] = r_N,i g₀,i, W = G M⁻¹Gᵀ (velocities relative to the obstacle).
/// In a step J changes by friction, loads, supports and damping alone, without penetration. Each touch is an elastic
/// impact of the contact nodes, which rebound: contact forces oscillate.
class LaursenLove final : public Kane {
 public:
  explicit LaursenLove(double step) : Kane(step, "laursen-love", 0.0) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    std::vector<OperatorCoefficients> result = Kane::operators(problem);
    result.push_back({1.0, 0.0, 0.0});
    return result;
  }
  [[nodiscard]] LastStep last_step() const override {
    LastStep result = Kane::last_step();
    result.other_stages = {&impulse_, acts_ ? 1U : 0U};
    return result;
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    Stage& stage = balance(problem, state, stages);
    require_contact(problem, state, stage);
    const StageSolution& solution = stages.solve(0);
    find_impulses(problem, stage, solution, state, stages);
    advance_state(problem, stage, solution, state, increment);
    if (acts_) state.velocity += kick_;
  }

 private:
  void find_impulses(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution,
                     const State& state, StageSolve& stages) {
    const double h = step();
    problem.gaps(state.displacement, state.time, gap_);
    points_.clear();
    for (Index i = 0; i < gap_.size(); ++i) {
      if (solution.normal_reaction[i] > 0.0 && gap_[i] > stage.conditions.gap.rounding[i]) points_.push_back(i);
    }
    acts_ = !points_.empty();
    if (!acts_) return;
    velocity_ = state.velocity + (2.0 / h) * solution.increment;  // V₁*
    impulse_.forces.rows = stage.rows;
    impulse_.obstacle_increment = stage.obstacle;
    project_motion(*stage.rows, impulse_.obstacle_increment);
    const ObstacleMotion& obstacle = impulse_.obstacle_increment;
    motion_from_obstacles(*stage.rows, velocity_, obstacle, approach_);
    const auto count = Index(points_.size());
    Vector approach(count), lost(count);
    for (Index k = 0; k < count; ++k) {
      const Index i = points_[std::size_t(k)];
      approach[k] = approach_[i];
      lost[k] = solution.normal_reaction[i] * gap_[i];
    }
    stages.stage(1).rows = stage.rows;
    const Vector p = restoring_impulses(response_.among(problem, *stage.rows, points_, stages), approach, lost);
    Vector& force = impulse_.forces.normal_reaction;
    force.setZero(gap_.size());
    for (Index k = 0; k < count; ++k) force[points_[std::size_t(k)]] = p[k] / h;
    kick(problem, stages);
  }

  /// Computes the change of the velocity, and the work of the impulses on the mean of the velocities before and after.
  void kick(const SemidiscreteProblem& problem, StageSolve& stages) {
    const double h = step();
    unloaded_stage(problem, 1, stages);
    const StageSolution& solution = solve_with_forces(problem, impulse_.forces.normal_reaction, 1, stages);
    kick_ = h * solution.increment;
    impulse_.weight = 1.0;
    impulse_.increment = h * (velocity_ + 0.5 * kick_);
    impulse_.forces.support_reaction = solution.support_reaction;
    impulse_.obstacle_increment.normal *= h;
    impulse_.obstacle_increment.tangential *= h;
    impulse_.obstacle_increment.in_space *= h;
  }

  ContactResponse response_{1};
  std::vector<Index> points_;
  Vector gap_, approach_, velocity_, kick_;
  OtherStageForces impulse_;
  bool acts_ = false;
};

}  // namespace

SchemeRegistration laursen_love_scheme() {
  return {"laursen-love", [](double step, const Parameters&) { return std::make_unique<LaursenLove>(step); }};
}

}  // namespace ricochet
