#include "ricochet/run/method_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Energy relative to the largest one below which a body is at rest: its changes are rounding.
constexpr double energy_at_rest = 1e-12;

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
  if (!velocity_corrections_) return;
  VelocityCorrections& found = *velocity_corrections_;
  visit.numbers("velocity_corrections", found.first_time, found.largest, found.time, largest_energy_);
  visit.integers("corrected_steps", {0, std::numeric_limits<std::int64_t>::max()}, found.steps);
}

void MethodWatch::enter_part(const StepCorrections& corrections) {
  const double energy = corrections.energy_at_end;
  largest_energy_ = std::max(largest_energy_, energy);
  if (energy > energy_at_rest * largest_energy_) corrected_share_ += std::abs(corrections.velocity_correction) / energy;
}

void MethodWatch::enter_step(const State& state, double method_energy) {
  last_ = method_energy;
  least_ = std::min(least_, last_);
  largest_ = std::max(largest_, last_);
  if (acting_ && *acting_ != ActingReaction::end) enter_weight(state.forces);
  if (velocity_corrections_) enter_velocity_correction(state.time);
}

void MethodWatch::enter_velocity_correction(double time) {
  VelocityCorrections& found = *velocity_corrections_;
  const double share = std::exchange(corrected_share_, 0.0);
  if (share > found.largest) {
    found.largest = share;
    found.time = time;
  }
  if (!(share > VelocityCorrections::noticeable)) return;
  ++found.steps;
  found.first_time = std::min(found.first_time, time);
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
