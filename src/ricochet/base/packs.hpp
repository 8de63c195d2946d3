#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "ricochet/base/instruction_sets.hpp"
#include "ricochet/base/types.hpp"

/// @file A few numbers side by side (SIMD), for loops that are compiled for several instruction sets. Included by
/// source files only: how wide vectors are passed to functions depends on the instruction set, so all calls must be
/// inlined.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace ricochet {

// Types of H numbers side by side, aligned or at any address.
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

// Functions of a double or of a pack, so that a formula is written once for both (`Number` is either).

/// Number of doubles in a Number.
template <class Number>
inline constexpr int lane_count = int(sizeof(Number) / sizeof(double));

/// Returns whether a comparison holds for some of them; `mask` is its result.
template <class Mask>
RICOCHET_PART_OF_CALLER bool any_of(const Mask& mask) {
  if constexpr (std::is_same_v<Mask, bool>) {
    return mask;
  } else {
    std::int64_t sum = 0;
    for (int i = 0; i < lane_count<Mask>; ++i) sum |= mask[i];
    return sum != 0;
  }
}

template <class Number>
RICOCHET_PART_OF_CALLER Number square_root(const Number& of) {
  if constexpr (std::is_same_v<Number, double>) {
    return std::sqrt(of);
  } else {
    Number result;
#if defined(__SSE2__)
    // Compilers check whether std::sqrt must set errno, and therefore compute one number after another.
    for (int i = 0; i < lane_count<Number>; i += 2) {
      const __m128d two = _mm_sqrt_pd(__m128d{of[i], of[i + 1]});
      result[i] = two[0];
      result[i + 1] = two[1];
    }
#else
    for (int i = 0; i < lane_count<Number>; ++i) result[i] = std::sqrt(of[i]);
#endif
    return result;
  }
}

/// Calls work.run<W>(), compiled for `instruction_set()`, with the number W of doubles in its registers (four if they
/// hold fewer). All functions that run calls are RICOCHET_PART_OF_CALLER.
#if defined(__x86_64__) && defined(__GNUC__)
template <class Work>
__attribute__((target("arch=x86-64-v4"))) void run_in_packs_avx512(const Work& work) {
  work.template run<8>();
}
template <class Work>
__attribute__((target("arch=x86-64-v3"))) void run_in_packs_avx2(const Work& work) {
  work.template run<4>();
}
#endif
template <class Work>
void run_in_packs(const Work& work) {
#if defined(__x86_64__) && defined(__GNUC__)
  const InstructionSet set = instruction_set();
  if (set == InstructionSet::avx512) return run_in_packs_avx512(work);
  if (set == InstructionSet::avx2) return run_in_packs_avx2(work);
#endif
  work.template run<4>();
}
/// Returns the W of run_in_packs.
[[nodiscard]] inline int pack_width() { return instruction_set() == InstructionSet::avx512 ? 8 : 4; }
inline constexpr int most_pack_width = 8;

/// Calls work(count) with a compile-time constant from 1 to `most` ≤ 8 for a run-time count; does nothing for 0. `work`
/// is a lambda marked RICOCHET_LAMBDA_OF_CALLER.
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
