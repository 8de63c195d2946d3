#pragma once

#include "ricochet/base/packs.hpp"
#include "ricochet/fem/cell_packs.hpp"

/// @file Conversion between contiguous numbers per node and packs with one number per cell. Included by source files
/// only. Not part of the public interface.
namespace ricochet {

/// Transposes the rows a, b, c, e into columns.
RICOCHET_PART_OF_CALLER void transpose(const Pack<4>& a, const Pack<4>& b, const Pack<4>& c, const Pack<4>& e,
                                       Pack<4>& first, Pack<4>& second, Pack<4>& third, Pack<4>& fourth) {
  const Pack<4> odd = __builtin_shufflevector(a, b, 0, 4, 2, 6), even = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Pack<4> next_odd = __builtin_shufflevector(c, e, 0, 4, 2, 6),
                next_even = __builtin_shufflevector(c, e, 1, 5, 3, 7);
  first = __builtin_shufflevector(odd, next_odd, 0, 1, 4, 5);
  second = __builtin_shufflevector(even, next_even, 0, 1, 4, 5);
  third = __builtin_shufflevector(odd, next_odd, 2, 3, 6, 7);
  fourth = __builtin_shufflevector(even, next_even, 2, 3, 6, 7);
}

/// Returns lanes 4k to 4k + 3.
template <int W>
RICOCHET_PART_OF_CALLER Pack<4> quarter(const Pack<W>& of, int k) {
  if constexpr (W == 4) {
    return of;
  } else {
    return k == 0 ? __builtin_shufflevector(of, of, 0, 1, 2, 3) : __builtin_shufflevector(of, of, 4, 5, 6, 7);
  }
}
/// Joins groups of four lanes.
template <int W>
RICOCHET_PART_OF_CALLER Pack<W> joined(const Pack<4>* parts, int stride) {
  if constexpr (W == 4) {
    return parts[0];
  } else {
    return __builtin_shufflevector(parts[0], parts[stride], 0, 1, 2, 3, 4, 5, 6, 7);
  }
}

/// Reads the components of the nodes of four cells at `slots`.
template <int d>
RICOCHET_PART_OF_CALLER void read_four(const double* numbers, const int* slots, Pack<4>* components) {
  if constexpr (d == 2) {
    const Pack<2> a = load<2>(numbers + 2 * slots[0]), b = load<2>(numbers + 2 * slots[1]),
                  c = load<2>(numbers + 2 * slots[2]), e = load<2>(numbers + 2 * slots[3]);
    const Pack<4> even = __builtin_shufflevector(a, c, 0, 1, 2, 3), odd = __builtin_shufflevector(b, e, 0, 1, 2, 3);
    components[0] = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    components[1] = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
  } else {
    const Pack<4> a = load<4>(numbers + 4 * slots[0]), b = load<4>(numbers + 4 * slots[1]),
                  c = load<4>(numbers + 4 * slots[2]), e = load<4>(numbers + 4 * slots[3]);
    Pack<4> rest;
    transpose(a, b, c, e, components[0], components[1], components[2], rest);
  }
}

/// Adds components to the nodes of four cells at `slots`, one cell after another.
template <int d>
RICOCHET_PART_OF_CALLER void add_four(const Pack<4>* components, const int* slots, double* numbers) {
  const Pack<4> even = __builtin_shufflevector(components[0], components[1], 0, 4, 2, 6),
                odd = __builtin_shufflevector(components[0], components[1], 1, 5, 3, 7);
  if constexpr (d == 2) {
    const auto add = [&](int lane, const Pack<2>& value) RICOCHET_LAMBDA_OF_CALLER {
      double* const to = numbers + 2 * slots[lane];
      store<2>(to, load<2>(to) + value);
    };
    add(0, __builtin_shufflevector(even, even, 0, 1));
    add(1, __builtin_shufflevector(odd, odd, 0, 1));
    add(2, __builtin_shufflevector(even, even, 2, 3));
    add(3, __builtin_shufflevector(odd, odd, 2, 3));
  } else {
    const auto add = [&](int lane, const Pack<4>& value) RICOCHET_LAMBDA_OF_CALLER {
      double* const to = numbers + 4 * slots[lane];
      store<4>(to, load<4>(to) + value);
    };
    const Pack<4> zero{};
    const Pack<4> z_even = __builtin_shufflevector(components[2], zero, 0, 4, 2, 6),
                  z_odd = __builtin_shufflevector(components[2], zero, 1, 5, 3, 7);
    add(0, __builtin_shufflevector(even, z_even, 0, 1, 4, 5));
    add(1, __builtin_shufflevector(odd, z_odd, 0, 1, 4, 5));
    add(2, __builtin_shufflevector(even, z_even, 2, 3, 6, 7));
    add(3, __builtin_shufflevector(odd, z_odd, 2, 3, 6, 7));
  }
}

/// Reads d packs per node of W cells. `slots`: per node one per cell.
template <int d, int W>
RICOCHET_PART_OF_CALLER void read_nodes(const double* numbers, const int* slots, int nodes, Pack<W>* result) {
  for (int i = 0; i < nodes; ++i, slots += W) {
    if constexpr (W == 4) {
      read_four<d>(numbers, slots, result + i * d);
    } else {
      Pack<4> low[d], high[d];
      read_four<d>(numbers, slots, low);
      read_four<d>(numbers, slots + 4, high);
      for (int a = 0; a < d; ++a) result[i * d + a] = __builtin_shufflevector(low[a], high[a], 0, 1, 2, 3, 4, 5, 6, 7);
    }
  }
}
template <int d, int W>
RICOCHET_PART_OF_CALLER void add_nodes(const Pack<W>* values, const int* slots, int nodes, double* numbers) {
  for (int i = 0; i < nodes; ++i, slots += W) {
    if constexpr (W == 4) {
      add_four<d>(values + i * d, slots, numbers);
    } else {
      Pack<4> low[d], high[d];
      for (int a = 0; a < d; ++a) {
        low[a] = __builtin_shufflevector(values[i * d + a], values[i * d + a], 0, 1, 2, 3);
        high[a] = __builtin_shufflevector(values[i * d + a], values[i * d + a], 4, 5, 6, 7);
      }
      add_four<d>(low, slots, numbers);
      add_four<d>(high, slots + 4, numbers);
    }
  }
}

}  // namespace ricochet
