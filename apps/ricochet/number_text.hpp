#pragma once

#include <string>

#include "ricochet/base/types.hpp"

/// @file Numbers as the program prints them.
namespace ricochet::program {

/// 0 where the value is no more than the rounding of numbers of that size.
[[nodiscard]] double without_rounding(double value, double size);

/// "1.2 %" of a part of 0.012.
[[nodiscard]] std::string percent(double part);

/// "(1, 0.5)", components by so many digits; those that are rounding of the size (of the vector, or one that is given
/// and larger) are 0.
[[nodiscard]] std::string vector_text(const Vector& values, double size = 0.0, int digits = 4);

}  // namespace ricochet::program
