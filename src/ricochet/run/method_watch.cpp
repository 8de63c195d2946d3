#include "ricochet/run/method_watch.hpp"

#include <algorithm>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

std::string name_of(ActingReaction acting) {
  switch (acting) {
    case ActingReaction::end:
      return "end";
    case ActingReaction::path_mean:
      return "mean";
    case ActingReaction::mixed_mean:
      return "adaptive";
  }
  return "";
}

}  // namespace

void MethodWatch::persist(const SnapshotVisitor& visit) {
  visit.numbers("numbers", least_, largest_, last_, least_weight_, largest_weight_);
  visit.integers("steps", {0, std::numeric_limits<std::int64_t>::max()}, mean_steps_, end_steps_);
}

void MethodWatch::enter_step(const State& state, double method_energy) {
  last_ = method_energy;
  least_ = std::min(least_, last_);
  largest_ = std::max(largest_, last_);
  if (acting_ && *acting_ != ActingReaction::end) enter_weight(state.forces);
}

/// Enters the weight of a step in which contact presses; weights of other steps act on nothing.
void MethodWatch::enter_weight(const StepForces& forces) {
  if (!ranks_->any((forces.mean_normal_reaction.array() > 0.0).any())) return;
  if (forces.end_weight == 1.0) {  // a mean that was found has a smaller weight
    ++end_steps_;
    return;
  }
  ++mean_steps_;
  least_weight_ = std::min(least_weight_, forces.end_weight);
  largest_weight_ = std::max(largest_weight_, forces.end_weight);
}

MethodEnergy MethodWatch::energy(double largest_energy) const {
  if (!(largest_energy > 0.0)) return {};
  return {std::max(0.0, -least_) / largest_energy, largest_ / largest_energy, last_ / largest_energy};
}

std::optional<ActingReactions> MethodWatch::reactions() const {
  if (!acting_) return std::nullopt;
  return ActingReactions{name_of(*acting_), least_weight_, largest_weight_, mean_steps_, end_steps_};
}

}  // namespace ricochet
