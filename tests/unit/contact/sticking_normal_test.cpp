#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/rigid/obstacle.hpp"

/// @file The normal of a step at a point that sticks to a rotating obstacle.
namespace ricochet {
namespace {

/// The point moves with the material up to rounding, which has no direction. At a rounded corner the gap contains more
/// rounding than at a plane: normals that follow it change in each iteration, and forces at a sticking node do not
/// settle.
TEST(StickingNormal, DoesNotFollowRounding) {
  std::mt19937 random(5);
  const auto number = [&] { return 2.0 * double(random()) / 4294967296.0 - 1.0; };
  TemporaryFolder folder(std::filesystem::temp_directory_path(), "wedge");
  std::ofstream(folder.file("wedge.txt")) << "-1 -1.5\n2 -1.6\n0.7 -0.02\n-1 -1.5\n";
  Parameters parameters;
  parameters.set("file", folder.file("wedge.txt"));
  parameters.set("edge_radius", 0.1);
  std::vector<Expression> rotation;
  rotation.emplace_back("0.3*t");
  const Obstacle wedge(make_obstacle_shape("surface", parameters), make_path({}, rotation, 2), 0.0,
                       Eigen::Vector2d(0.0, -1.0));
  int rounded = 0;
  for (int k = 0; k < 2000; ++k) {
    const SpaceVector at = Eigen::Vector2d(0.7, -0.02) + 0.15 * Eigen::Vector2d(number(), number());
    if (std::abs(wedge.shape().gap(at)) > 0.05) continue;
    if (wedge.shape().gradient(at).norm() < 0.99) ++rounded;
    const double time = 1.0 + number();
    const PosedObstacle before = wedge.at(time), after = wedge.at(time + 0.05);
    const SpaceVector from = before.pose().to_space(at), noise = 1e-15 * Eigen::Vector2d(number(), number());
    const SpaceVector to = after.pose().to_space(at) + noise;
    const SpaceVector normal = normal_of_step(before, from, after, to);
    // The normal in the middle of the rotation.
    const SpaceVector mean = (before.normal(from) + after.normal(to)).normalized();
    EXPECT_LT((normal - mean).norm(), 1e-9) << at.transpose();
  }
  EXPECT_GT(rounded, 100);
}

}  // namespace
}  // namespace ricochet
