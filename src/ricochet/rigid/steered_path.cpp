#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/rigid/obstacle_path.hpp"

/// @file Obstacles whose motion a program sets during the run.
namespace ricochet {

namespace {

/// A step evaluates an obstacle at its ends and in the previous step, so older legs are never needed.
constexpr std::size_t most_legs = 8;

void check_rates(const char* what, const SpaceVector& rates, Index count) {
  if (rates.size() != count)
    throw Error(ErrorKind::invalid_input,
                fmt::format("its {} has {} numbers, but {} are required", what, rates.size(), count));
  if (!rates.allFinite()) throw Error(ErrorKind::invalid_input, fmt::format("its {} is not finite", what));
}

}  // namespace

SteeredPath::SteeredPath(std::unique_ptr<const ObstaclePath> before, Index dimension)
    : before_(std::move(before)), dimension_(dimension), rotations_(dimension == 3 ? 3 : 1) {}

const SteeredPath::Leg* SteeredPath::leg_at(double time) const {
  for (auto leg = legs_.rbegin(); leg != legs_.rend(); ++leg) {
    if (time >= leg->start) return &*leg;
  }
  return nullptr;
}

SpaceVector SteeredPath::displacement(double time) const {
  if (const Leg* leg = leg_at(time)) return leg->displacement + (time - leg->start) * leg->velocity;
  return before_ != nullptr ? before_->displacement(time) : SpaceVector(SpaceVector::Zero(dimension_));
}

SpaceVector SteeredPath::rotation(double time) const {
  if (const Leg* leg = leg_at(time)) return leg->rotation + (time - leg->start) * leg->rotation_rate;
  return rotates() ? before_->rotation(time) : SpaceVector(SpaceVector::Zero(rotations_));
}

void SteeredPath::steer(double time, const SpaceVector& velocity, const SpaceVector& rotation_rate) {
  check_rates("velocity", velocity, dimension_);
  Leg leg{time, displacement(time), rotation(time), velocity, SpaceVector::Zero(rotations_)};
  if (rotation_rate.size() > 0) {
    if (!rotates())
      throw Error(ErrorKind::invalid_input,
                  "it has no rotation whose rate could be set: add one to the case, which can be zero, as in rotation "
                  "= \"0\" (a rotation_rate in the case rotates its surface in place and remains unchanged)");
    check_rates("rotation rate", rotation_rate, rotations_);
    leg.rotation_rate = rotation_rate;
  }
  while (!legs_.empty() && legs_.back().start >= time) legs_.pop_back();
  if (legs_.size() == most_legs) legs_.erase(legs_.begin());
  legs_.push_back(std::move(leg));
}

void SteeredPath::persist(const SnapshotVisitor& visit) {
  const SpaceVector motion = SpaceVector::Zero(dimension_), rotation = SpaceVector::Zero(rotations_);
  visit.list("", legs_, most_legs, Leg{0.0, motion, rotation, motion, rotation});
}

}  // namespace ricochet
