#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/simulation/impact/impacts.hpp"

/// @file Impacts in checkpoints.
namespace ricochet {

/// Every comparison is false for NaN.
bool ImpactRecorder::fits(const Interval& interval) const {
  constexpr double largest_count = 1e15;
  const auto is_count = [](double number) { return number >= 0.0 && number < largest_count; };
  return interval.collision >= 0.0 && interval.collision < static_cast<double>(collision_pairs_.size()) &&
         interval.collision == std::floor(interval.collision) &&
         (interval.phase == no_contact || interval.phase == touching || interval.phase == apart) &&
         is_count(interval.intervals) && is_count(interval.most_points);
}

void ImpactRecorder::persist(const SnapshotVisitor& visit) {
  visit.numbers("open", open_);
  visit.list("filed", completed_, most_impacts);
  visit("left_out", left_out_);
  visit("method_energy", method_before_);
  if (!visit.loads()) return;
  bool all_fit = true;
  for (const auto* list : {&open_, &completed_}) {
    for (const Interval& interval : *list) all_fit = all_fit && fits(interval);
  }
  for (std::size_t collision = 0; collision < collision_pairs_.size(); ++collision)
    all_fit = all_fit && open_[collision].collision == static_cast<double>(collision);
  if (!all_fit)
    throw Error(ErrorKind::invalid_input, "the checkpoint's record of impacts does not belong to this case");
}

}  // namespace ricochet
