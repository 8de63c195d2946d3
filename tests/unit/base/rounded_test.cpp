#include "ricochet/base/rounded.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace ricochet {
namespace {

/// A rounded number in a message, copied by a user, is a bound as the exact number is.
TEST(Rounded, WhatIsPrintedIsABound) {
  for (const double value : {0.00705, 1.0, 9.99999, 9.94, 123456.0, 6.1602e-3, 2.0 / 3.0, 1e-300, 5e299}) {
    for (int digits = 1; digits <= 3; ++digits) {
      const double down = std::stod(fmt::format("{:.{}g}", rounded_down(value, digits), digits));
      const double up = std::stod(fmt::format("{:.{}g}", rounded_up(value, digits), digits));
      EXPECT_LE(down, value * (1.0 + 1e-8));
      EXPECT_GE(up, value * (1.0 - 1e-8));
      EXPECT_LE(up - down, std::pow(10.0, 1 - digits) * value * (1.0 + 1e-8));
    }
  }
  EXPECT_DOUBLE_EQ(rounded_down(0.00705, 2), 0.0070);
  EXPECT_DOUBLE_EQ(rounded_up(1.4001, 2), 1.5);
  EXPECT_DOUBLE_EQ(rounded_down(0.3, 2), 0.3);
  EXPECT_DOUBLE_EQ(rounded_up(0.3, 2), 0.3);
}

}  // namespace
}  // namespace ricochet
