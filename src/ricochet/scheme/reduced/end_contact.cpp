#include "ricochet/scheme/reduced/end_contact.hpp"

#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

constexpr const char* stick_slip = "stick_slip";

/// True if sticking points have a position to return to: rows that rotate with the motion have other tangents in each
/// step.
bool has_fixed_tangents(const SemidiscreteProblem& problem) {
  return problem.contact.has_friction() && !problem.contact.follows_motion();
}

}  // namespace

void StickingDrift::require(const SemidiscreteProblem& problem, const State& state, double step, Stage& stage) {
  if (!has_fixed_tangents(problem)) return;
  const auto memory = state.memory.find(stick_slip);
  if (memory == state.memory.end()) return;
  if (memory->second.size() != stage.conditions.slip.offset.size())
    Snapshot::refuse(stick_slip, "belongs to other contact points");
  stage.conditions.slip.offset += memory->second / step;
}

void StickingDrift::update_drift(const SemidiscreteProblem& problem, const Vector& before, State& state) {
  if (!has_fixed_tangents(problem)) return;
  motion_ = state.displacement - before;  // rounded, as in the displacement
  state.forces.rows->tangential_motion(motion_, slip_);
  if (state.obstacle_increment.tangential.size() > 0) slip_ -= state.obstacle_increment.tangential;
  Vector& memory = state.memory[stick_slip];
  if (memory.size() != slip_.size()) memory.setZero(slip_.size());
  const Index tangents = problem.dimension - 1;
  for (Index i = 0; i < problem.contact.size(); ++i) {
    const bool sticks = state.contact_status[std::size_t(i)] == ContactStatus::stick;
    for (Index k = i * tangents; k < (i + 1) * tangents; ++k) memory[k] = sticks ? memory[k] + slip_[k] : 0.0;
  }
}

void EndContact::require(const SemidiscreteProblem& problem, ActingReaction acting, double step, const State& state,
                         const Vector& end_displacement, StepEquations& equations, Stage& stage,
                         const Vector* linear_about) {
  const StepStart start{state.displacement, state.time};
  const bool is_linear_elsewhere = linear_about != nullptr && problem.contact.follows_motion();
  const auto& require_gaps = is_linear_elsewhere ? prepare_no_penetration : require_no_penetration;
  require_gaps(problem, end_displacement, state.time + step, stage, &start);
  stage.conditions.gap.factor = 2.0;
  equations.observe_step(problem, state.displacement, state.time, end_displacement, step, stage);
  rate_ = (end_displacement - state.displacement) / step;
  require_friction(problem, rate_, 2.0 / step, stage);
  stick_.require(problem, state, step, stage);
  if (is_linear_elsewhere) {
    linearize_contact(problem, *linear_about, stage);
    stage.conditions.gap.rounding = stage.rows->gap_rounding;
  }
  if (acting == ActingReaction::end) return;
  problem.gaps(state.displacement, state.time, stage.start.gap);
  stage.start.normal_reaction = state.forces.normal_reaction;
  stage.start.tangential_reaction = state.forces.tangential_reaction;
}

}  // namespace ricochet
