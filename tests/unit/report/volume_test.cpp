#include "ricochet/report/simplices.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "support/box_mesh.hpp"

namespace ricochet::test_support {
namespace {

/// Index in `volume.nodes` of corner k of a tetrahedron.
int vertex_of(const Simplices& volume, Index t, int k) { return volume.corners[std::size_t(4 * t + k)]; }

double volume_of(const Points& nodes, const Simplices& volume, Index t) {
  const auto corner = [&](int k) {
    return Eigen::Vector3d(nodes.col(volume.nodes[std::size_t(vertex_of(volume, t, k))]));
  };
  return std::abs((corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0))) / 6.0;
}

/// Number of tetrahedra that share each face, and of those that mark it as a cell face.
struct Faces {
  std::map<std::array<int, 3>, int> times, of_cells;
  explicit Faces(const Simplices& volume) {
    for (Index t = 0; t < volume.count(); ++t) {
      for (int k = 0; k < 4; ++k) {
        std::array<int, 3> face{};
        for (std::size_t i = 0; i < 3; ++i) face[i] = vertex_of(volume, t, (k + 1 + int(i)) % 4);
        std::ranges::sort(face);
        ++times[face];
        of_cells[face] += volume.sides[std::size_t(t)] >> k & 1;
      }
    }
  }
};

class VolumeOf : public testing::TestWithParam<ElementKind> {};

/// The tetrahedra fill the unit cube without gap or overlap, also if the cells' vertices are displaced.
TEST_P(VolumeOf, ACubeIsComplete) {
  const ElementKind& kind = GetParam();
  const auto body = make_meshed_body(make_box_mesh(box_of(kind.shape, {2, 2, 2})), kind.displacement_degree);
  const Points& nodes = body->space.nodes;
  const Simplices volume = make_volume(nodes, body->space.cells, 1000000);
  EXPECT_FALSE(volume.is_thinned);
  const Index cells = body->space.cells.front().size();
  const Index parts = kind.displacement_degree == 2 ? 8 : 1;
  EXPECT_EQ(volume.count(), cells * parts * (kind.shape == CellShape::hexahedron ? 6 : 1));
  std::map<int, double> of_cell;
  for (Index t = 0; t < volume.count(); ++t) of_cell[volume.cells[std::size_t(t)]] += volume_of(nodes, volume, t);
  EXPECT_EQ(Index(of_cell.size()), cells);
  double sum = 0.0;
  for (const auto& [cell, part] : of_cell) sum += part;
  EXPECT_NEAR(sum, 1.0, 1e-13);

  // A face belongs to two tetrahedra, on the cube's surface to one, and both agree on whether it is a cell face.
  double surface = 0.0;
  const Faces faces(volume);
  for (const auto& [face, times] : faces.times) {
    EXPECT_LE(times, 2);
    EXPECT_TRUE(faces.of_cells.at(face) == 0 || faces.of_cells.at(face) == times);
    const auto corner = [&, &corners = face](std::size_t k) {
      return Eigen::Vector3d(nodes.col(volume.nodes[std::size_t(corners[k])]));
    };
    if (times != 1) continue;
    surface += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    EXPECT_EQ(faces.of_cells.at(face), 1);
  }
  EXPECT_NEAR(surface, 6.0, 1e-12);
}

/// Without a cut, the boundary of the volume is the drawn surface, triangle by triangle.
TEST_P(VolumeOf, ItsOutsideIsTheSurface) {
  const ElementKind& kind = GetParam();
  const auto body = make_meshed_body(make_box_mesh(box_of(kind.shape, {2, 2, 2})), kind.displacement_degree);
  const Simplices volume = make_volume(body->space.nodes, body->space.cells, 1000000);
  const Simplices surface = make_surface(body->space.nodes, body->space.cells, 1000000);
  const auto in_body = [](std::array<int, 3> corners, const std::vector<Index>& nodes) {
    std::array<Index, 3> result{};
    for (std::size_t k = 0; k < 3; ++k) result[k] = nodes[std::size_t(corners[k])];
    std::ranges::sort(result);
    return result;
  };
  std::set<std::array<Index, 3>> outside, drawn;
  for (const auto& [face, times] : Faces(volume).times) {
    if (times == 1) outside.insert(in_body(face, volume.nodes));
  }
  for (std::size_t t = 0; t < surface.cells.size(); ++t) {
    const int* corners = surface.corners.data() + 3 * t;
    drawn.insert(in_body({corners[0], corners[1], corners[2]}, surface.nodes));
  }
  EXPECT_EQ(outside, drawn);
}

/// The number of tetrahedra is limited: first only the vertices are used, which still fill the cube, then larger cells.
TEST_P(VolumeOf, ManyCellsAreMadeFewer) {
  const ElementKind& kind = GetParam();
  const auto body = make_meshed_body(make_box_mesh(box_of(kind.shape, {4, 4, 4})), kind.displacement_degree);
  const Points& nodes = body->space.nodes;
  const Index of_vertices = body->space.cells.front().size() * (kind.shape == CellShape::hexahedron ? 6 : 1);
  const Simplices plain = make_volume(nodes, body->space.cells, of_vertices);
  EXPECT_FALSE(plain.is_thinned);
  EXPECT_EQ(plain.count(), of_vertices);
  double sum = 0.0;
  for (Index t = 0; t < plain.count(); ++t) sum += volume_of(nodes, plain, t);
  EXPECT_NEAR(sum, 1.0, 1e-12);

  const Simplices coarse = make_volume(nodes, body->space.cells, of_vertices / 2);
  EXPECT_TRUE(coarse.is_thinned);
  EXPECT_LE(coarse.count(), of_vertices / 2);
  EXPECT_GT(coarse.count(), of_vertices / 20);
  for (const int cell : coarse.cells) EXPECT_LT(cell, body->space.cells.front().size());
}

INSTANTIATE_TEST_SUITE_P(Elements, VolumeOf,
                         testing::Values(ElementKind{CellShape::tetrahedron, 1, 1},
                                         ElementKind{CellShape::tetrahedron, 1, 2},
                                         ElementKind{CellShape::hexahedron, 1, 1},
                                         ElementKind{CellShape::hexahedron, 1, 2}));

TEST(Volume, PlaneCellsHaveNone) {
  const auto body = make_meshed_body(make_box_mesh(box_of(CellShape::triangle, {2, 2})), 1);
  Points nodes = Points::Zero(3, body->space.nodes.cols());
  nodes.topRows(2) = body->space.nodes;
  EXPECT_EQ(make_volume(nodes, body->space.cells, 1000).count(), 0);
}

}  // namespace
}  // namespace ricochet::test_support
