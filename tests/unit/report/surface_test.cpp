#include "ricochet/report/simplices.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <set>

#include "ricochet/report/contact_line.hpp"
#include "ricochet/simulation/monitor/surface_pieces.hpp"
#include "support/box_mesh.hpp"

namespace ricochet::test_support {
namespace {

/// Nodes in three rows, as in files.
Points in_space(const Points& nodes) {
  Points result = Points::Zero(3, nodes.cols());
  result.topRows(nodes.rows()) = nodes;
  return result;
}

/// Index in `surface.nodes` of corner k of a triangle.
int corner_of(const Simplices& surface, Index t, int k) { return surface.corners[std::size_t(3 * t + k)]; }

double area(const Points& nodes, const Simplices& surface, Index t) {
  const auto corner = [&](int k) {
    return Eigen::Vector3d(nodes.col(surface.nodes[std::size_t(corner_of(surface, t, k))]));
  };
  return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
}

struct Sides {
  std::map<std::pair<int, int>, int> times, edges;  ///< triangles with a side, and those that mark it as a cell edge
  explicit Sides(const Simplices& surface) {
    for (Index t = 0; t < surface.count(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int a = corner_of(surface, t, k), b = corner_of(surface, t, (k + 1) % 3);
        const auto side = std::minmax(a, b);
        ++times[side];
        edges[side] += (surface.sides[std::size_t(t)] >> k) & 1;
      }
    }
  }
};

class SurfaceOf : public testing::TestWithParam<ElementKind> {};

/// The whole square in the plane (area 1), or the cube's boundary in space (area 6), for all cells.
TEST_P(SurfaceOf, ABoxIsComplete) {
  const ElementKind& kind = GetParam();
  const BoxMesh box = box_of(kind.shape, std::vector<int>(std::size_t(kind.dimension()), 3));
  const auto body = make_meshed_body(make_box_mesh(box), kind.displacement_degree);
  const Points nodes = in_space(body->space.nodes);
  const Simplices surface = make_surface(nodes, body->space.cells, 1000000);
  EXPECT_FALSE(surface.is_thinned);
  double sum = 0.0;
  for (Index t = 0; t < surface.count(); ++t) sum += area(nodes, surface, t);
  EXPECT_NEAR(sum, kind.dimension() == 2 ? 1.0 : 6.0, 1e-13);

  // In space every side belongs to two triangles; in the plane those of the outline to one. Both agree on whether it is
  // a cell edge.
  const Sides sides(surface);
  Index outline = 0;
  for (const auto& [side, times] : sides.times) {
    ASSERT_LE(times, 2);
    if (times == 1) ++outline;
    const int edges = sides.edges.at(side);
    EXPECT_TRUE(edges == 0 || edges == times);
    if (times == 1) {
      EXPECT_EQ(edges, 1);
    }
  }
  EXPECT_EQ(outline, kind.dimension() == 2 ? 4 * 3 * kind.displacement_degree : 0);

  // Every named node exists and occurs once.
  EXPECT_EQ(std::set<Index>(surface.nodes.begin(), surface.nodes.end()).size(), surface.nodes.size());
  for (const int node : surface.corners) EXPECT_LT(std::size_t(node), surface.nodes.size());
  if (kind.dimension() == 2) {
    Index cells = 0;
    for (const CellBlock& block : body->space.cells) cells += block.size();
    EXPECT_EQ(Index(std::set<int>(surface.cells.begin(), surface.cells.end()).size()), cells);
    EXPECT_EQ(Index(surface.nodes.size()), nodes.cols());
  }
}

/// A triangle lies in its assigned cell: all its corners are nodes of that cell.
TEST_P(SurfaceOf, TrianglesBelongToTheirCells) {
  const ElementKind& kind = GetParam();
  const BoxMesh box = box_of(kind.shape, std::vector<int>(std::size_t(kind.dimension()), 2));
  const auto body = make_meshed_body(make_box_mesh(box), kind.displacement_degree);
  const Simplices surface = make_surface(in_space(body->space.nodes), body->space.cells, 1000000);
  const CellBlock& block = body->space.cells.front();
  for (Index t = 0; t < surface.count(); ++t) {
    const Index* cell = block.cell(surface.cells[std::size_t(t)]);
    for (int k = 0; k < 3; ++k) {
      const Index node = surface.nodes[std::size_t(corner_of(surface, t, k))];
      EXPECT_NE(std::find(cell, cell + block.nodes_per_cell, node), cell + block.nodes_per_cell);
    }
  }
}

/// The surface on a page is that of contact detection: the same facets, subdivided at the same points. In the plane it
/// is the outline of the page's surface.
TEST_P(SurfaceOf, ItIsTheOneThatContactSees) {
  const ElementKind& kind = GetParam();
  const BoxMesh box = box_of(kind.shape, std::vector<int>(std::size_t(kind.dimension()), 2));
  const auto body = make_meshed_body(make_box_mesh(box), kind.displacement_degree);
  const DisplacementSpace& space = body->space;
  std::multiset<BodySurface::Piece> seen, shown;
  for (BodySurface::Piece piece : surface_pieces(space.nodes, space.cells, boundary_facets(space.cells))) {
    std::ranges::sort(piece);
    seen.insert(piece);
  }
  const Simplices surface = make_surface(in_space(space.nodes), space.cells, 1000000);
  const auto number = [&](int local) { return surface.nodes[std::size_t(local)]; };
  if (kind.dimension() == 2) {
    for (const auto& [side, times] : Sides(surface).times) {
      BodySurface::Piece piece{-1, number(side.first), number(side.second)};
      std::ranges::sort(piece);
      if (times == 1) shown.insert(piece);
    }
  } else {
    for (std::size_t t = 0; t < surface.cells.size(); ++t) {
      BodySurface::Piece piece;
      for (std::size_t k = 0; k < 3; ++k) piece[k] = number(surface.corners[3 * t + k]);
      std::ranges::sort(piece);
      shown.insert(piece);
    }
  }
  EXPECT_FALSE(seen.empty());
  EXPECT_EQ(shown, seen);
}

INSTANTIATE_TEST_SUITE_P(Elements, SurfaceOf, testing::ValuesIn(all_element_kinds()),
                         [](const auto& info) { return info.param.label(); });

TEST(Surface, IsThinnedToWhatIsAskedFor) {
  const Mesh mesh = make_box_mesh(box_of(CellShape::triangle, {60, 60}));
  const Points nodes = in_space(mesh.nodes);
  const Simplices surface = make_surface(nodes, mesh.cells, 2000);
  EXPECT_TRUE(surface.is_thinned);
  EXPECT_LE(surface.count(), 2000);
  EXPECT_GT(surface.count(), 500);
  double sum = 0.0;
  for (Index t = 0; t < surface.count(); ++t) sum += area(nodes, surface, t);
  EXPECT_NEAR(sum, 1.0, 0.1) << "still the square";
}

TEST(ContactLine, FollowsASideFromItsLeftEnd) {
  for (const int degree : {1, 2}) {
    const auto body = make_meshed_body(make_box_mesh(box_of(CellShape::quadrilateral, {4, 3})), degree);
    // The facets of the bottom and the top, in any order.
    std::vector<CellBlock> facets{{CellShape::interval, degree + 1, {}, {}}};
    for (const char* name : {"y1", "y0"}) {
      for (const Index facet : body->mesh.group(name, 1).members) {
        const IndexInBlocks place = locate_facet(body->space, facet);
        const Index* nodes = body->space.facets[place.block].cell(place.local);
        facets[0].nodes.insert(facets[0].nodes.end(), nodes, nodes + degree + 1);
        facets[0].tags.push_back(0);
      }
    }
    const Points nodes = in_space(body->space.nodes);
    const ContactLine line = make_contact_line(nodes, facets);
    const std::size_t piece = std::size_t(4 * degree + 1);
    ASSERT_EQ(line.nodes.size(), 2 * piece);
    EXPECT_EQ(line.pieces, (std::vector<int>{0, int(piece)}));
    for (std::size_t i = 0; i < piece; ++i) {
      EXPECT_NEAR(nodes(1, line.nodes[i]), 0.0, 1e-15) << "the lower one of two left ends first";
      EXPECT_NEAR(line.position[i], nodes(0, line.nodes[i]), 1e-14);
      EXPECT_NEAR(line.position[piece + i], 1.1 + nodes(0, line.nodes[piece + i]), 1e-14) << "after a gap";
    }
  }
}

TEST(ContactLine, GoesAroundAClosedPiece) {
  Points nodes(3, 4);
  nodes << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  const std::vector<CellBlock> facets{{CellShape::interval, 2, {2, 3, 0, 1, 3, 0, 1, 2}, {1, 2, 3, 4}}};
  const ContactLine line = make_contact_line(nodes, facets);
  EXPECT_EQ(line.nodes.front(), 0);
  EXPECT_EQ(line.nodes.size(), 4U);
  EXPECT_EQ(line.position, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_TRUE(make_contact_line(nodes, {}).nodes.empty());
}

TEST(ContactLine, HasNoOrderInSpace) {
  const Points nodes = Points::Zero(3, 9);
  const std::vector<CellBlock> facets{{CellShape::triangle, 3, {8, 2, 5, 5, 2, 1}, {1, 2}}};
  const ContactLine line = make_contact_line(nodes, facets);
  EXPECT_EQ(line.nodes, (std::vector<Index>{1, 2, 5, 8}));
  EXPECT_TRUE(line.position.empty());
}

}  // namespace
}  // namespace ricochet::test_support
