#include "ricochet/solver/corotated/corotated_frame.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "support/case_run.hpp"

namespace ricochet::test_support {
namespace {

CaseRun block() {
  const std::string mesh = mesh_geometry(
      "corotated-block", "Rectangle(1) = {0.2, 0.1, 0, 1, 0.6};\nPhysical Surface(\"body\") = {1};\n", 0.4, 1);
  return CaseRun(
      "[mesh]\nfile = \"" + mesh +
      "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 1.0\npoisson = 0.3\nlaw = \"neo-hookean\"\n"
      "[mass]\ntype = \"consistent\"\n[time]\nscheme = \"hht-alpha\"\nstep = 1e-3\nend = 1e-3\n");
}

/// The factor of such a displacement is that of the body with a part of its strains, in its own frame.
TEST(CorotatedFrame, ScalesStrainsWithoutRotations) {
  const CaseRun run = block();
  const CorotatedFrame frame(run.problem());
  const Points& nodes = run.problem().nodes;
  const Matrix turn = Eigen::Rotation2Dd(0.8).toRotationMatrix();
  Matrix stretch = Matrix::Identity(2, 2);
  stretch(0, 0) = 1.3;
  stretch(1, 1) = 0.9;
  const auto displacement_of = [&](const Matrix& gradient) {
    return Vector(((gradient - Matrix::Identity(2, 2)) * nodes).reshaped());
  };
  const Vector moved = displacement_of(turn * stretch);
  Vector whole, part;
  frame.scale_strains(moved, 1.0, whole);
  // The gradient of homogeneous positions, from differences of three nodes.
  Matrix edges(2, 2), moved_edges(2, 2);
  for (const Index k : {0, 1}) {
    edges.col(k) = nodes.col(k + 1) - nodes.col(0);
    moved_edges.col(k) = edges.col(k) + whole.segment<2>(2 * (k + 1)) - whole.segment<2>(0);
  }
  const Matrix gradient = moved_edges * edges.inverse();
  EXPECT_LT((gradient.transpose() * gradient - stretch * stretch).norm(), 1e-12);
  EXPECT_LT(std::abs(gradient(0, 1) - gradient(1, 0)), 0.1);  // hardly any rotation is left
  frame.scale_strains(moved, 0.25, part);
  EXPECT_LT((part - 0.25 * whole).norm(), 1e-14);
  Vector scaled;
  frame.scale_strains(displacement_of(turn), 0.5, scaled);
  EXPECT_LT(scaled.norm(), 1e-13);
}

}  // namespace
}  // namespace ricochet::test_support
