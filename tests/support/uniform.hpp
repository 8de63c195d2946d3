#pragma once

#include <random>

#include "ricochet/base/types.hpp"

/// @file Random numbers between −1 and 1, the same on every system.
namespace ricochet::test_support {

[[nodiscard]] inline double uniform(std::mt19937& random) { return double(random()) / 2147483648.0 - 1.0; }

[[nodiscard]] inline Vector uniform(Index size, std::mt19937& random) {
  Vector result(size);
  for (double& value : result) value = uniform(random);
  return result;
}

}  // namespace ricochet::test_support
