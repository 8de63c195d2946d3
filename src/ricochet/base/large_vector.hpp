#pragma once

#include <cstddef>
#include <vector>

#include "ricochet/base/memory.hpp"

/// @file Arrays that a step reads from one end to the other.
namespace ricochet {

/// Large arrays lie in huge pages where the system has them for those who ask: the processor looks up fewer addresses
/// then, and a product with a matrix of three dofs per node takes a tenth less.
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
