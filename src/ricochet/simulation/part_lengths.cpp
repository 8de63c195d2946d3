#include "ricochet/simulation/part_lengths.hpp"

#include <algorithm>

namespace ricochet {

void PartLengths::enter_solution() {
  const long length = whole >> level_;
  done_ = (done_ + length) % whole;
  for (long& wait : wait_) wait = std::max(wait - length, 0L);
  if (!is_shortest()) pause_[std::size_t(level_)] = 1;
  if (level_ == 0) return;
  const int longer = level_ - 1;
  if (done_ % (whole >> longer) == 0 && wait_[std::size_t(longer)] == 0) level_ = longer;
}

void PartLengths::enter_failure() {
  int& pause = pause_[std::size_t(level_)];
  wait_[std::size_t(level_)] = pause * (whole >> level_);
  pause = std::min(2 * pause, longest_pause);
  ++level_;
}

void PartLengths::persist(const SnapshotVisitor& visit) {
  visit("level", level_, {0, deepest});
  visit("wait", wait_, {0, longest_pause * whole}, deepest);
  visit("pause", pause_, {1, longest_pause}, deepest);
}

}  // namespace ricochet
