#pragma once

#include <algorithm>
#include <array>

#include "ricochet/base/types.hpp"

/// @file Threads. Results are the same bits for any number of threads: work is split so that each output entry is
/// computed by one thread, in an order that does not depend on the split, and sums are always split in the same way.
///
/// The threads are created once and wait between calls: first spinning, for some tens of microseconds, then asleep. A
/// call costs a few microseconds while they spin and some tens while they sleep; it allocates nothing.
namespace ricochet {

/// Sets the number of threads used by parallel_ranges (1 unless set). Throws Error(usage) unless 1 ≤ count ≤ 1024.
void set_thread_count(int count);
[[nodiscard]] int thread_count();

namespace detail {
/// A function of a range, without the allocation of std::function.
struct RangeWork {
  const void* object = nullptr;
  void (*call)(const void* object, Index begin, Index end) = nullptr;
  bool one_by_one = false;  ///< one range per item, if their number permits it
};
void run_ranges(Index count, const RangeWork& work);
}  // namespace detail

/// Calls `work(begin, end)` on consecutive ranges that cover [0, count), several at once. If ranges throw, the
/// exception of the first one is rethrown when all have ended, so that messages do not depend on timing. Inside of
/// `work`, and while another thread is in such a call, it runs on the calling thread alone.
template <class Work>
void parallel_ranges(Index count, const Work& work) {
  detail::run_ranges(count, {&work, [](const void* object, Index begin, Index end) {
                               (*static_cast<const Work*>(object))(begin, end);
                             }});
}

/// Calls `work(i)` for all i in [0, count), several at once, each as soon as a thread is free: for a few items of
/// different cost. Otherwise like parallel_ranges.
template <class Work>
void parallel_items(Index count, const Work& work) {
  detail::run_ranges(count, {&work,
                             [](const void* object, Index begin, Index end) {
                               for (Index i = begin; i < end; ++i) (*static_cast<const Work*>(object))(i);
                             },
                             true});
}

/// Σ of `work(begin, end)` over ranges that cover [0, count) and depend on `count` only, added in their order: the same
/// bits for any number of threads. `Sum{}` is zero.
template <class Sum, class Work>
[[nodiscard]] Sum parallel_sum(Index count, const Work& work) {
  constexpr Index most_parts = 64;
  constexpr Index least_size = 2048;
  const Index size = std::max(least_size, (count + most_parts - 1) / most_parts);
  const Index parts = (count + size - 1) / size;
  std::array<Sum, most_parts> sums;
  parallel_ranges(parts, [&](Index first, Index last) {
    for (Index part = first; part < last; ++part) {
      sums[std::size_t(part)] = work(part * size, std::min(count, (part + 1) * size));
    }
  });
  Sum total{};
  for (Index part = 0; part < parts; ++part) total += sums[std::size_t(part)];
  return total;
}

}  // namespace ricochet
