#pragma once

#include <functional>

#include "ricochet/base/types.hpp"

/// @file Threads. Whatever their number, results are the same bits: work is split so that each output entry is computed
/// by one thread, in an order that does not depend on the split.
namespace ricochet {

/// Number of threads used by parallel_ranges (1 unless set). Throws Error(usage) unless 1 ≤ count ≤ 1024.
void set_thread_count(int count);
[[nodiscard]] int thread_count();

/// Calls `work(begin, end)` on consecutive ranges that cover [0, count), at once. An exception of any range is rethrown
/// (that of the first range, so that messages do not depend on timing).
void parallel_ranges(Index count, const std::function<void(Index begin, Index end)>& work);

}  // namespace ricochet
