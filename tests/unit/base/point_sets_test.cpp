#include "ricochet/base/point_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ricochet {
namespace {

Points random_points(int dimension, int count, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Points points(dimension, count);
  for (double& x : points.reshaped()) x = normal(random);
  return points;
}

TEST(PointSets, OfShapesThatAreKnown) {
  const double third = std::sqrt(3.0);
  Points square(2, 5), triangle(2, 3), tetrahedron(3, 4), line(3, 4), needle(2, 4);
  square << 0, 3, 3, 0, 1, 0, 0, 4, 4, 1;
  triangle << 0, 1, 0.5, 0, 0, 0.5 * third;
  tetrahedron << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  line << 0, 1, 2, 5, 0, 1, 2, 5, 0, 0, 0, 0;
  needle << 0, 10, 5, 5, 0, 0, 1e-9, -1e-9;
  EXPECT_NEAR(enclosing_diameter(square), 5.0, 1e-14);
  EXPECT_NEAR(enclosing_diameter(triangle), 2.0 / third, 1e-14);
  EXPECT_NEAR(enclosing_diameter(tetrahedron), 2.0 * third, 1e-14);
  EXPECT_NEAR(enclosing_diameter(line), std::sqrt(50.0), 1e-13);
  EXPECT_NEAR(enclosing_diameter(needle), 10.0, 1e-13);
  EXPECT_NEAR(largest_distance(square), 5.0, 1e-14);
  EXPECT_EQ(enclosing_diameter(Points(3, 0)), 0.0);
  EXPECT_EQ(enclosing_diameter(Points::Constant(3, 4, 7.0)), 0.0);
}

/// Jung's theorem: the diameter is between the largest distance D and D√(2d/(d + 1)). All nodes on a sphere bound it.
TEST(PointSets, HoldAllPointsInABallThatIsNoLargerThanJungs) {
  std::mt19937 random{3};
  for (int round = 0; round < 40; ++round) {
    const int d = 2 + round % 2;
    Points points = random_points(d, 3 + 11 * round, random);
    const bool on_sphere = round % 4 < 2 && points.cols() > 30;
    if (on_sphere) points.colwise().normalize();
    const double diameter = enclosing_diameter(points), distance = largest_distance(points);
    EXPECT_GE(diameter, (1.0 - 1e-12) * distance);
    EXPECT_LE(diameter, (1.0 + 1e-12) * distance * std::sqrt(2.0 * d / (d + 1.0)));
    if (on_sphere && d == 2) {
      EXPECT_NEAR(diameter, 2.0, 1e-11);
    }
  }
}

}  // namespace
}  // namespace ricochet
