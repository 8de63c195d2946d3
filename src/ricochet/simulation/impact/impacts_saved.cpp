#include "ricochet/base/error.hpp"
#include "ricochet/simulation/impact/impacts.hpp"

/// @file Impacts in checkpoints.
namespace ricochet {

bool ImpactRecorder::fits(const Interval& interval) const {
  return interval.collision < collision_pairs_.size() && interval.phase >= no_contact && interval.phase <= apart &&
         interval.intervals >= 0 && interval.most_points >= 0;
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
    all_fit = all_fit && open_[collision].collision == collision;
  if (!all_fit)
    throw Error(ErrorKind::invalid_input, "the checkpoint's record of impacts does not belong to this case");
}

}  // namespace ricochet
