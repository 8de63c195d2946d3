#include "ricochet/fem/mesh_measures.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <map>

#include "ricochet/mesh/reference_cell.hpp"
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
    box.counts.assign(std::size_t(d), 3);
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

/// The height is the least distance of the highest vertex from a facet: of equal cells in a unit box of n³, 1/n
/// (quadrilaterals, hexahedra) or 1/(n√2) (right triangles).
TEST_P(MeshMeasures, HeightsOfCells) {
  const int d = dimension(GetParam());
  BoxMesh box;
  box.shape = GetParam();
  box.counts.assign(std::size_t(d), 4);
  box.distortion = 0.0;
  const Mesh mesh = make_box_mesh(box);
  // A tetrahedron is one of six of a cube, with a largest facet of √2/2 (an edge and a diagonal of a side).
  const std::map<CellShape, double> closed_forms{
      {CellShape::triangle, 0.25 / std::sqrt(2.0)},
      {CellShape::quadrilateral, 0.25},
      {CellShape::tetrahedron, 3.0 * (1.0 / 6.0) / (std::sqrt(2.0) / 2.0) * 0.25},
      {CellShape::hexahedron, 0.25}};
  const std::vector<double> heights = cell_heights(mesh);
  ASSERT_EQ(Index(heights.size()), mesh.cell_count());
  const CellBlock& block = mesh.cells.front();
  for (Index cell = 0; cell < block.size(); ++cell) {
    const auto at = [&](int vertex) {
      Eigen::Vector3d result = Eigen::Vector3d::Zero();
      result.head(d) = mesh.nodes.col(block.cell(cell)[vertex]);
      return result;
    };
    double least = 1.0;
    for (const std::vector<int>& facet : outward_facet_vertices(block.shape)) {
      const Eigen::Vector3d across = d == 2 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(at(facet[2]) - at(facet[0]));
      const Eigen::Vector3d normal = (at(facet[1]) - at(facet[0])).cross(across).normalized();
      double highest = 0.0;
      for (int vertex = 0; vertex < vertex_count(block.shape); ++vertex)
        highest = std::max(highest, std::abs(normal.dot(at(vertex) - at(facet[0]))));
      least = std::min(least, highest);
    }
    const double height = heights[std::size_t(cell)];
    EXPECT_NEAR(height, least, 1e-14);
    if (closed_forms.contains(block.shape)) {
      EXPECT_NEAR(height, closed_forms.at(block.shape), 1e-14);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, MeshMeasures, testing::ValuesIn(all_cell_shapes()),
                         [](const auto& info) { return name(info.param); });

}  // namespace
}  // namespace ricochet::test_support
