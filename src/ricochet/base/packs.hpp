#pragma once

#include "ricochet/base/instruction_sets.hpp"

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

}  // namespace ricochet
