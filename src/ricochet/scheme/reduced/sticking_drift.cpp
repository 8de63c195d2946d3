#include "ricochet/scheme/reduced/sticking_drift.hpp"

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
    const bool sticks = state.contact_status[static_cast<std::size_t>(i)] == ContactStatus::stick;
    for (Index k = i * tangents; k < (i + 1) * tangents; ++k) memory[k] = sticks ? memory[k] + slip_[k] : 0.0;
  }
}

}  // namespace ricochet
