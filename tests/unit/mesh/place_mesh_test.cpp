#include "ricochet/mesh/place_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support.hpp"

namespace ricochet::test_support {
namespace {

Mesh points(const Matrix& nodes) {
  Mesh mesh;
  mesh.source = "points";
  mesh.dimension = int(nodes.rows());
  mesh.nodes = nodes;
  return mesh;
}

TEST(PlaceMesh, QuarterTurnsInThePlaneAreExact) {
  Matrix nodes(2, 2), expected(2, 2);
  nodes << 3.0, 0.1, 1.0, 0.7;
  for (const auto& [angle, c, s] : {std::tuple{90.0, 0.0, 1.0}, std::tuple{180.0, -1.0, 0.0},
                                    std::tuple{-90.0, 0.0, -1.0}, std::tuple{450.0, 0.0, 1.0}}) {
    Mesh mesh = points(nodes);
    place_mesh(mesh, {{{angle, {}, {}}}, {}});
    expected << c * nodes.row(0) - s * nodes.row(1), s * nodes.row(0) + c * nodes.row(1);
    EXPECT_TRUE((mesh.nodes.array() == expected.array()).all()) << angle << "\n" << mesh.nodes;
  }
}

TEST(PlaceMesh, TurnsAboutAnAxisThroughAPointThenMoves) {
  Matrix nodes(3, 3), expected(3, 3);
  nodes << 2.0, 1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0, 5.0;
  // A rotation by 120° about the diagonal through (1, 1, 1) maps x to y, y to z, z to x.
  expected << 1.0, 1.0, 5.0, 2.0, 1.0, 1.0, 1.0, 2.0, 1.0;
  expected.colwise() += Eigen::Vector3d(10.0, 20.0, 30.0);
  Mesh mesh = points(nodes);
  place_mesh(mesh, {.rotations = {{.angle = 120.0, .axis = {7.0, 7.0, 7.0}, .about = {1.0, 1.0, 1.0}}},
                    .move = {10.0, 20.0, 30.0}});
  EXPECT_LT((mesh.nodes - expected).cwiseAbs().maxCoeff(), 40 * 2.3e-16) << mesh.nodes;
}

TEST(PlaceMesh, AgreesWithQuaternions) {
  const Matrix nodes = Matrix::Random(3, 20);
  const Eigen::Vector3d axis(0.3, -2.0, 0.7);
  for (const double angle : {-1000.0, -45.0, 1e-3, 44.9, 45.0, 135.0, 224.0, 359.0}) {
    Mesh mesh = points(nodes);
    place_mesh(mesh, {{{angle, {axis.x(), axis.y(), axis.z()}, {}}}, {}});
    const double radians = std::remainder(angle, 360.0) * M_PI / 180.0;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(radians, axis.normalized()));
    EXPECT_LT((mesh.nodes - turn.toRotationMatrix() * nodes).cwiseAbs().maxCoeff(), 2e-15) << angle;
  }
}

/// Rotations do not commute: the first maps x to y and the second that to z; the other order leaves it at y.
TEST(PlaceMesh, TurnsOneAfterTheOther) {
  const MeshRotation about_z{90.0, {0.0, 0.0, 1.0}, {}}, about_x{90.0, {1.0, 0.0, 0.0}, {}};
  for (const auto& [turns, expected] : {std::pair{std::vector{about_z, about_x}, Eigen::Vector3d(0.0, 0.0, 1.0)},
                                        std::pair{std::vector{about_x, about_z}, Eigen::Vector3d(0.0, 1.0, 0.0)}}) {
    Mesh mesh = points(Eigen::Vector3d(1.0, 0.0, 0.0));
    place_mesh(mesh, {turns, {}});
    EXPECT_TRUE((mesh.nodes.col(0).array() == expected.array()).all()) << mesh.nodes.transpose();
  }
}

TEST(PlaceMesh, OverflowIsAnError) {
  Mesh mesh = points(Matrix::Constant(2, 1, 1e308));
  EXPECT_TRUE(has(message_of([&] { place_mesh(mesh, {{}, {1e308, 0.0}}); }), "overflow"));
}

}  // namespace
}  // namespace ricochet::test_support
