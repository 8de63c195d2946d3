#pragma once

#include <cmath>

/// @file Bounds in messages: a number that a user takes over must not lie on the other side of what it stands for.
namespace ricochet {

/// `value`, positive and finite, rounded down to `digits` significant digits; may exceed it by 1e-9 of it.
[[nodiscard]] inline double rounded_down(double value, int digits) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
  return std::floor(value / unit * (1.0 + 1e-9)) * unit;
}

/// The same rounded up; may fall short of it by 1e-9 of it.
[[nodiscard]] inline double rounded_up(double value, int digits) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
  return std::ceil(value / unit * (1.0 - 1e-9)) * unit;
}

}  // namespace ricochet
