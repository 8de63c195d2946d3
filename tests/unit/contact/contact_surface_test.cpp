#include "ricochet/contact/contact_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

/// @file Position of the end of contact on an edge between a closed node and an open one.
namespace ricochet {
namespace {

/// p = ½E* c √s and g = ⅔ c s^{3/2} at distances θh and (1 − θ)h from the border return θ, for any c, E* and h.
TEST(PressedPartOfEdge, IsThatOfTheBorderOfSmoothContact) {
  for (const double part : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.999}) {
    for (const double c : {1e-3, 7.0}) {
      const double modulus = 2.5e11, edge = 4e-6;
      const double pressure = 0.5 * modulus * c * std::sqrt(part * edge);
      const double gap = 2.0 / 3.0 * c * std::pow((1.0 - part) * edge, 1.5);
      EXPECT_NEAR(pressed_part_of_edge(pressure * edge / (modulus * gap)), part, 1e-9 * part);
    }
  }
}

TEST(PressedPartOfEdge, AtTheEnds) {
  EXPECT_EQ(pressed_part_of_edge(0.0), 0.0);
  EXPECT_EQ(pressed_part_of_edge(std::numeric_limits<double>::infinity()), 1.0);
  EXPECT_GE(pressed_part_of_edge(1e-200), 0.0);
  EXPECT_LE(pressed_part_of_edge(1e200), 1.0);
}

}  // namespace
}  // namespace ricochet
