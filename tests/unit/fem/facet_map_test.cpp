#include "ricochet/fem/facet_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/box_mesh.hpp"

// Positions on curved facets, projected along a direction, are recovered.

namespace ricochet::test_support {
namespace {

/// Axes that are perpendicular to a direction near the last axis, d × (d−1).
Points tilted_axes(int d) {
  if (d == 2) return Eigen::Rotation2Dd(0.2).toRotationMatrix().leftCols(1);
  return Eigen::AngleAxisd(0.2, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix().leftCols(2);
}

TEST(FacetMap, FindsThePlacesThatItGives) {
  for (const CellShape shape : all_cell_shapes()) {
    for (const int degree : {1, 2}) {
      const int d = dimension(shape);
      const auto test = make_meshed_body(
          make_box_mesh({shape, d == 2 ? std::vector{4, 3} : std::vector{3, 2, 3}, degree, 0.15, bend_map()}), degree);
      const FacetMap map(test->body);
      const Points axes = tilted_axes(d);
      for (const Index facet : test->mesh.group(d == 2 ? "y1" : "z1", d - 1).members) {
        const CellShape facet_shape = test->mesh.facets[locate_facet(test->space, facet).block].shape;
        const Points local = quadrature(facet_shape, 5).points;
        Points positions, found;
        map.positions(facet, local, positions);
        ASSERT_TRUE(map.invert(facet, axes, axes.transpose() * positions, found));
        EXPECT_LT((found - local).lpNorm<Eigen::Infinity>(), 1e-13) << name(shape) << degree;
        // The shape functions of the displacement, which are also the geometry's, give the same positions.
        Matrix values;
        map.displacement(facet, local, values);
        const IndexInBlocks place = locate_facet(test->space, facet);
        const CellBlock& block = test->space.facets[place.block];
        Points sum = Points::Zero(d, local.cols());
        for (int k = 0; k < block.nodes_per_cell; ++k)
          sum += test->space.nodes.col(block.cell(place.local)[k]) * values.row(k);
        EXPECT_LT((positions - sum).lpNorm<Eigen::Infinity>(), 1e-14) << name(shape) << degree;
      }
    }
  }
}

TEST(FacetMap, FindsNothingOnAFacetThatIsSeenEdgeOn) {
  const auto test = make_meshed_body(make_box_mesh({CellShape::tetrahedron, {2, 2, 2}, 1, 0.0, {}}), 1);
  const FacetMap map(test->body);
  Points found;
  for (const Index facet : test->mesh.group("z1", 2).members)
    EXPECT_FALSE(map.invert(facet, Matrix::Identity(3, 3).rightCols(2), Points::Constant(2, 1, 0.5), found));
}

}  // namespace
}  // namespace ricochet::test_support
