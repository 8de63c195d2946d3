#include "ricochet/fem/mesh_measures.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "support/box_mesh.hpp"

// Sizes and positions of groups, compared with boxes, parallelepipeds and discs.

namespace ricochet::test_support {
namespace {

class MeshMeasures : public testing::TestWithParam<CellShape> {};

/// A box under an affine map A: volume det A, side 0 with area |A e₁ × A e₂| and its normal out of the body.
TEST_P(MeshMeasures, OfAParallelepiped) {
  const int d = dimension(GetParam());
  Matrix whole(3, 3);
  whole << 2.0, 0.3, 0.1, 0.2, 1.0, -0.4, 0.1, -0.2, 0.5;
  const Matrix a = whole.topLeftCorner(d, d);
  const Vector shift = Vector::LinSpaced(d, 3.0, 5.0);
  for (const int degree : {1, 2}) {
    BoxMesh box;
    box.shape = GetParam();
    box.counts.assign(static_cast<std::size_t>(d), 3);
    box.geometry_degree = degree;
    box.map = affine_map(a, shift);
    const Mesh mesh = make_box_mesh(box);
    const MeshMeasure body = measure_group(mesh, mesh.group("body", d));
    EXPECT_NEAR(body.size, std::abs(a.determinant()), 1e-13);
    EXPECT_LT((body.centre.head(d) - (a * Vector::Constant(d, 0.5) + shift)).norm(), 1e-13);
    EXPECT_EQ(body.mean_normal.norm(), 0.0);
    const Vector lowest = shift + a.cwiseMin(0.0).rowwise().sum(), highest = shift + a.cwiseMax(0.0).rowwise().sum();
    EXPECT_LT((body.lowest.head(d) - lowest).norm(), 1e-13);
    EXPECT_LT((body.highest.head(d) - highest).norm(), 1e-13);
    // The normal of the side x = 1 is parallel to that row of A⁻¹; its area is det A times the length of the row.
    const Vector row = a.inverse().row(0).transpose();
    for (const double side : {0.0, 1.0}) {
      const MeshMeasure facets = measure_group(mesh, mesh.group(side == 0.0 ? "x0" : "x1", d - 1));
      EXPECT_NEAR(facets.size, std::abs(a.determinant()) * row.norm(), 1e-13);
      EXPECT_LT((facets.mean_normal.head(d) - (side == 0.0 ? -1.0 : 1.0) * row.normalized()).norm(), 1e-13);
      EXPECT_EQ(facets.inside, 0);
      Vector middle = Vector::Constant(d, 0.5);
      middle[0] = side;
      EXPECT_LT((facets.centre.head(d) - (a * middle + shift)).norm(), 1e-13);
    }
    // Around the whole body the normals cancel.
    EXPECT_LT(measure_group(mesh, mesh.group("boundary", d - 1)).mean_normal.norm(), 1e-14);
  }
}

/// Equal cells in a unit box of n³ have the height 1/n (quadrilaterals, hexahedra) or 1/(n√2) (right triangles).
TEST_P(MeshMeasures, HeightsOfCells) {
  const int d = dimension(GetParam());
  BoxMesh box;
  box.shape = GetParam();
  box.counts.assign(static_cast<std::size_t>(d), 4);
  box.distortion = 0.0;
  const Mesh mesh = make_box_mesh(box);
  double expected = 0.25;
  if (GetParam() == CellShape::triangle) expected /= std::sqrt(2.0);
  const std::vector<double> heights = cell_heights(mesh);
  ASSERT_EQ(static_cast<Index>(heights.size()), mesh.cell_count());
  for (const double height : heights) {
    if (GetParam() == CellShape::tetrahedron) {
      // Six cells to a cube, each 1/6 of it, with a largest facet of √2/2 (an edge and a diagonal of a side).
      EXPECT_NEAR(height, 3.0 * (1.0 / 6.0) / (std::sqrt(2.0) / 2.0) * 0.25, 1e-14);
    } else {
      EXPECT_NEAR(height, expected, 1e-14);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, MeshMeasures, testing::ValuesIn(all_cell_shapes),
                         [](const auto& info) { return name(info.param); });

}  // namespace
}  // namespace ricochet::test_support
