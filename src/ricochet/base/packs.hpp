#pragma once

#include <type_traits>

#include "ricochet/base/instruction_sets.hpp"
#include "ricochet/base/types.hpp"

/// @file A few numbers side by side, for loops that are compiled for several instruction sets. Included by source files
/// only: how wide vectors are passed to functions depends on the instruction set, so all calls must be inlined.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace ricochet {

// H numbers side by side, aligned or anywhere in memory.
template <int H>
struct Lanes;
#define RICOCHET_LANES(count)                                                       \
  template <>                                                                       \
  struct Lanes<count> {                                                             \
    typedef double Value __attribute__((vector_size(8 * (count))));                 \
    typedef double Unaligned __attribute__((vector_size(8 * (count)), aligned(8))); \
  };
RICOCHET_LANES(2)
RICOCHET_LANES(4)
RICOCHET_LANES(8)
#undef RICOCHET_LANES
template <int H>
using Pack = typename Lanes<H>::Value;

template <int H>
RICOCHET_PART_OF_CALLER Pack<H> load(const double* from) {
  return *reinterpret_cast<const typename Lanes<H>::Unaligned*>(from);
}
template <int H>
RICOCHET_PART_OF_CALLER void store(double* to, const Pack<H>& value) {
  *reinterpret_cast<typename Lanes<H>::Unaligned*>(to) = value;
}

/// Calls work(count) with a constant from 1 to `most` ≤ 8 for a count that is known only now; does nothing for 0.
/// `work` is a lambda marked RICOCHET_LAMBDA_OF_CALLER.
#if defined(__GNUC__)
#define RICOCHET_LAMBDA_OF_CALLER __attribute__((always_inline))
#else
#define RICOCHET_LAMBDA_OF_CALLER
#endif
template <int most, class Work>
RICOCHET_PART_OF_CALLER void with_constant(Index count, const Work& work) {
  switch (count) {
    case 1:
      return work(std::integral_constant<int, 1>{});
    case 2:
      return work(std::integral_constant<int, 2>{});
    case 3:
      return work(std::integral_constant<int, 3>{});
    case 4:
      return work(std::integral_constant<int, 4>{});
    case 5:
      return work(std::integral_constant<int, 5>{});
    case 6:
      return work(std::integral_constant<int, 6>{});
    case 7:
      return work(std::integral_constant<int, 7>{});
    case 8:
      if constexpr (most == 8) work(std::integral_constant<int, 8>{});
      return;
    default:
      return;
  }
}

}  // namespace ricochet
