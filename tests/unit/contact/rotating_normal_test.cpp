#include "ricochet/contact/rotating_normal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/box_mesh.hpp"

/// @file A direction that rotates with the facets around a point.
namespace ricochet::test_support {
namespace {

/// Facets of a bent and distorted box around one of its corners, on several of its sides.
std::vector<Index> facets_around(const DisplacementSpace& space, Index node) {
  Index count = 0;
  for (const CellBlock& block : space.facets) count += block.size();
  std::vector<Index> result;
  for (Index facet = 0; facet < count; ++facet) {
    const std::vector<Index> nodes = facet_nodes(space, {facet});
    if (std::ranges::find(nodes, node) != nodes.end()) result.push_back(facet);
  }
  return result;
}

/// The order of the facets in a mesh file has no effect on the surface.
TEST(RotatingNormal, NoOrderOfFacetsMatters) {
  for (const CellShape shape : all_cell_shapes()) {
    const int d = dimension(shape);
    BoxMesh box = box_of(shape, std::vector<int>(std::size_t(d), 3));
    box.map = bend_map();
    const auto body = make_meshed_body(make_box_mesh(box), 1);
    const DisplacementSpace& space = body->space;
    Vector direction(d), displacement(space.dof_count());
    for (Index k = 0; k < displacement.size(); ++k) displacement[k] = 0.05 * std::sin(3.0 + 7.0 * double(k));
    int turning = 0;
    for (Index node = 0; node < space.node_count(); ++node) {
      std::vector<Index> facets = facets_around(space, node);
      if (facets.size() < 2) continue;
      const Vector outward = space.nodes.col(node) - space.nodes.rowwise().mean();
      direction = outward.normalized();
      const RotatingNormal one(space, facets, direction);
      std::ranges::reverse(facets);
      const RotatingNormal other(space, facets, direction);
      EXPECT_EQ(one.rotates(), other.rotates());
      EXPECT_LT((one.at(space.nodes, {}).head(d) - direction).norm(), 1e-14);
      EXPECT_LT((one.at(space.nodes, displacement) - other.at(space.nodes, displacement)).norm(), 1e-13);
      turning += one.rotates() ? 1 : 0;
    }
    EXPECT_GT(turning, 4);
  }
}

}  // namespace
}  // namespace ricochet::test_support
