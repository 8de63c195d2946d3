#pragma once

#include <cmath>

/// @file Bounds in messages: a number that a user copies must lie on the admissible side of the exact bound.
namespace ricochet {

/// Rounds `value`, positive and finite, down to `digits` significant digits; may exceed it by 1e-9 of it.
[[nodiscard]] inline double rounded_down(double value, int digits) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
  return std::floor(value / unit * (1.0 + 1e-9)) * unit;
}

/// Rounds up in the same way; may fall short of it by 1e-9 of it.
[[nodiscard]] inline double rounded_up(double value, int digits) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
  return std::ceil(value / unit * (1.0 - 1e-9)) * unit;
}

}  // namespace ricochet
