#pragma once

#include <string>

#include "ricochet/base/types.hpp"

/// @file Numbers as the program prints them.
namespace ricochet::program {

/// Returns 0 if the value does not exceed the rounding of numbers of that size.
[[nodiscard]] double without_rounding(double value, double size);

/// Returns "1.2 %" for 0.012.
[[nodiscard]] std::string percent(double part);

/// Returns a text such as "(1, 0.5)" with so many digits per component; components below the rounding of the vector, or
/// of a given larger size, are 0.
[[nodiscard]] std::string vector_text(const Vector& values, double size = 0.0, int digits = 4);

}  // namespace ricochet::program
