#include "ricochet/simulation/part_lengths.hpp"

#include <algorithm>
#include <vector>

namespace ricochet {

void PartLengths::record_solution() {
  const long length = whole >> level_;
  done_ = (done_ + length) % whole;
  if (!memory_) {
    while (level_ > (done_ > 0 ? 1 : 0) && done_ % (whole >> (level_ - 1)) == 0) --level_;
    return;
  }
  for (Attempts& each : attempts_) each.wait = std::max(each.wait - length, 0L);
  if (!is_shortest()) attempts_[std::size_t(level_)].pause = 1;
  if (level_ == 0) return;
  const int longer = level_ - 1;
  if (done_ % (whole >> longer) == 0 && attempts_[std::size_t(longer)].wait == 0) level_ = longer;
}

void PartLengths::record_failure() {
  Attempts& own = attempts_[std::size_t(level_)];
  own.wait = own.pause * (whole >> level_);
  own.pause = std::min(2 * own.pause, longest_pause);
  ++level_;
}

void PartLengths::persist(const SnapshotVisitor& visit) {
  visit("level", level_, {0, deepest});
  std::vector<long> wait;
  std::vector<int> pause;
  for (const Attempts& each : attempts_) {
    wait.push_back(each.wait);
    pause.push_back(each.pause);
  }
  visit("wait", wait, {0, longest_pause * whole}, deepest);
  visit("pause", pause, {1, longest_pause}, deepest);
  for (std::size_t k = 0; k < attempts_.size(); ++k) attempts_[k] = {wait[k], pause[k]};
}

}  // namespace ricochet
