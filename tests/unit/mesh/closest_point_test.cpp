#include "ricochet/mesh/search/closest_point.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <set>
#include <vector>

namespace ricochet {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

/// Checks y, the closest point to x, by the variational inequality (x − y)·(c − y) ≤ 0 at every corner c, with equality
/// at the corners that span it, of which y is a mean with positive weights. Nothing else is closest.
void expect_closest(const Eigen::Vector3d& x, const ClosestPoint& closest, const Corners& corners) {
  constexpr double rounding = 1e-12;
  std::vector<Eigen::Index> spanning;
  for (const int corner : closest.corners)
    if (corner >= 0) spanning.push_back(corner);
  ASSERT_FALSE(spanning.empty());
  for (const Eigen::Vector3d& corner : corners)
    EXPECT_LE((x - closest.position).dot(corner - closest.position), rounding);
  Eigen::Matrix4Xd span(4, static_cast<Eigen::Index>(spanning.size()));
  for (std::size_t k = 0; k < spanning.size(); ++k) {
    const Eigen::Vector3d& corner = corners[std::size_t(spanning[k])];
    EXPECT_NEAR((x - closest.position).dot(corner - closest.position), 0.0, rounding);
    span.col(static_cast<Eigen::Index>(k)) << corner, 1.0;
  }
  const Eigen::Vector4d position(closest.position[0], closest.position[1], closest.position[2], 1.0);
  const Eigen::VectorXd weights = span.colPivHouseholderQr().solve(position);
  EXPECT_LE((span * weights - position).norm(), rounding) << "it is not among the corners that are said to span it";
  EXPECT_GE(weights.minCoeff(), -rounding);
}

TEST(ClosestPoint, IsOptimalAndSpannedByItsCorners) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto point = [&] { return Eigen::Vector3d(number(engine), number(engine), number(engine)); };
  std::set<std::array<int, 3>> regions;
  for (int k = 0; k < 2000; ++k) {
    const Corners corners{point(), point(), point()};
    const Eigen::Vector3d x = 2.0 * point();
    const ClosestPoint on_triangle = closest_on_triangle(x, corners[0], corners[1], corners[2]);
    expect_closest(x, on_triangle, corners);
    regions.insert(on_triangle.corners);
    expect_closest(x, closest_on_segment(x, corners[0], corners[1]), {corners[0], corners[1]});
  }
  EXPECT_EQ(regions.size(), 7U) << "three corners, three edges and the interior";
}

}  // namespace
}  // namespace ricochet
