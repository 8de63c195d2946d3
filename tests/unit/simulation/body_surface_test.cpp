#include "ricochet/simulation/monitor/body_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/simulation/monitor/surface_pieces.hpp"
#include "support/box_mesh.hpp"

// The surface of a unit box, meshed with every cell shape: distances compared with the closed form.

namespace ricochet::test_support {
namespace {

std::unique_ptr<MeshedBody> box_of(CellShape shape, int degree) {
  const int d = dimension(shape);
  return make_meshed_body(make_box_mesh({shape, d == 2 ? std::vector{4, 3} : std::vector{3, 2, 3}, 1, 0.15, {}}),
                          degree);
}

/// Distance to the surface of [0, 1]ᵈ, negative inside.
double distance_to_box(const Eigen::Vector3d& point, int d) {
  double outside = 0.0, inside = 1.0;
  for (int k = 0; k < d; ++k) {
    const double beyond = std::max({-point[k], point[k] - 1.0, 0.0});
    outside += beyond * beyond;
    inside = std::min({inside, point[k], 1.0 - point[k]});
  }
  return outside > 0.0 ? std::sqrt(outside) : -inside;
}

TEST(BoundaryFacets, AreThoseOfTheGroupThatNamesTheBoundary) {
  for (const CellShape shape : all_cell_shapes()) {
    for (const int degree : {1, 2}) {
      const auto box = box_of(shape, degree);
      const DisplacementSpace& space = box->space;
      std::vector<std::vector<Index>> found, wanted;
      const auto sorted = [](std::vector<Index> nodes) {
        std::ranges::sort(nodes);
        return nodes;
      };
      for (const CellFacet& facet : boundary_facets(space.cells))
        found.push_back(sorted(nodes_of_facet(space.cells, facet)));
      for (const Index facet : box->mesh.group("boundary", box->mesh.dimension - 1).members) {
        const IndexInBlocks place = locate_facet(space, facet);
        const CellBlock& block = space.facets[place.block];
        wanted.push_back(sorted({block.cell(place.local), block.cell(place.local) + block.nodes_per_cell}));
      }
      std::ranges::sort(found);
      std::ranges::sort(wanted);
      EXPECT_EQ(found, wanted) << name(shape) << " of degree " << degree;
    }
  }
}

TEST(BodySurface, KnowsTheDistanceToABoxWhereverItHasMovedTo) {
  const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(0, 0, 1));
  const Eigen::Vector3d shift(3.0, -2.0, 0.0);
  for (const CellShape shape : all_cell_shapes()) {
    for (const int degree : {1, 2}) {
      const auto box = box_of(shape, degree);
      const int d = box->mesh.dimension;
      const Points& nodes = box->space.nodes;
      const auto facets = boundary_facets(box->space.cells);
      BodySurface surface(nodes, surface_pieces(nodes, box->space.cells, facets));
      Vector displacement(box->space.dof_count());
      for (Index node = 0; node < nodes.cols(); ++node) {
        Eigen::Vector3d at = Eigen::Vector3d::Zero();
        at.head(d) = nodes.col(node);
        displacement.segment(node * d, d) = (turn * at + shift - at).head(d);
      }
      std::mt19937 random(1);
      const auto points = [&](const auto& check) {
        for (int i = 0; i < 300; ++i) {
          Eigen::Vector3d point = Eigen::Vector3d::Zero();
          for (int k = 0; k < d; ++k) point[k] = -0.5 + 2.0 * double(random()) / 4294967295.0;
          check(point);
        }
      };
      points([&](const Eigen::Vector3d& point) {
        EXPECT_NEAR(surface.signed_distance(point), distance_to_box(point, d), 1e-14) << name(shape) << degree;
      });
      surface.move(nodes, displacement);
      points([&](const Eigen::Vector3d& point) {
        EXPECT_NEAR(surface.signed_distance(turn * point + shift), distance_to_box(point, d), 1e-14)
            << name(shape) << degree;
      });
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
