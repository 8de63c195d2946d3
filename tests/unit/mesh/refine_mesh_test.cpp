#include "ricochet/mesh/refine_mesh.hpp"

#include <gtest/gtest.h>

#include <set>

#include "ricochet/mesh/boundary_facets.hpp"
#include "support/box_mesh.hpp"
#include "support/errors.hpp"

namespace ricochet::test_support::refine_mesh_test {

BoxMesh bent_box(CellShape shape, int degree) {
  return {shape, dimension(shape) == 2 ? std::vector<int>{4, 3} : std::vector<int>{3, 2, 2}, degree, 0.15, bend_map()};
}

double moment(const Mesh& mesh) {
  // Together with the geometry's determinant a polynomial that the rule integrates exactly.
  return integrate(*make_meshed_body(mesh, mesh.degree), 10, [](const Vector& x) { return 1.0 + x[0] - 2.0 * x[1]; });
}

class RefineMesh : public testing::TestWithParam<std::tuple<CellShape, int>> {};

TEST_P(RefineMesh, KeepsTheBodyAndItsGroups) {
  const auto [shape, degree] = GetParam();
  const Mesh mesh = make_box_mesh(bent_box(shape, degree));
  const int d = mesh.dimension;
  for (const int times : {0, 1, 2}) {
    Mesh fine = mesh;
    refine(fine, times);
    const Index parts = Index{1} << (d * times), of_facets = Index{1} << ((d - 1) * times);
    EXPECT_EQ(fine.cell_count(), parts * mesh.cell_count());
    EXPECT_EQ(fine.facet_count(), of_facets * mesh.facet_count());
    // Curved cells are divided along their geometry: the body is unchanged to rounding.
    const double whole = moment(mesh);
    EXPECT_NEAR(moment(fine), whole, 1e-12 * std::abs(whole));
    for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
      const Group &coarse = mesh.groups[g], &group = fine.groups[g];
      EXPECT_EQ(group.name, coarse.name);
      EXPECT_EQ(Index(group.members.size()),
                Index(coarse.members.size()) * (coarse.dimension == d ? parts : of_facets));
      EXPECT_TRUE(std::ranges::is_sorted(group.members));
    }
  }
}

/// Cells share whole facets: facets of one cell only are those of the original surface, divided.
TEST_P(RefineMesh, LeavesNoGaps) {
  const auto [shape, degree] = GetParam();
  Mesh mesh = make_box_mesh(bent_box(shape, degree));
  const auto before = boundary_facets(mesh.cells).size();
  const std::vector<std::int64_t> tags = mesh.node_tags;
  const Points nodes = mesh.nodes;
  refine(mesh, 1);
  EXPECT_EQ(boundary_facets(mesh.cells).size(), before << (mesh.dimension - 1));
  EXPECT_EQ(mesh.nodes.leftCols(nodes.cols()), nodes);
  EXPECT_TRUE(std::equal(tags.begin(), tags.end(), mesh.node_tags.begin()));
  EXPECT_EQ(mesh.node_tags.size(), std::size_t(mesh.node_count()));
  std::set<std::vector<double>> places;
  for (Index i = 0; i < mesh.node_count(); ++i)
    places.insert(std::vector<double>(mesh.nodes.col(i).begin(), mesh.nodes.col(i).end()));
  EXPECT_EQ(places.size(), std::size_t(mesh.node_count())) << "two nodes at one position";
  // The nodes are exactly those of the cells.
  std::set<Index> used;
  for (const CellBlock& block : mesh.cells) used.insert(block.nodes.begin(), block.nodes.end());
  EXPECT_EQ(used.size(), std::size_t(mesh.node_count()));
}

/// All parts are correctly oriented, and none is much thinner than its parent.
TEST_P(RefineMesh, HasNoTangledCells) {
  const auto [shape, degree] = GetParam();
  Mesh mesh = make_box_mesh(bent_box(shape, degree));
  refine(mesh, 2);
  const double volume = integrate(*make_meshed_body(mesh, degree), 2, [](const Vector&) { return 1.0; });
  EXPECT_GT(volume, 0.0);
  const auto body = make_meshed_body(mesh, degree);
  const SparseMatrix mass = assemble_scalar_mass(body->body, node_graph(body->space));
  EXPECT_GT(Vector(mass.diagonal()).minCoeff(), 0.0);
  // Vertices of straight simplices: six times the volume of each.
  if (degree == 2 || shape == CellShape::quadrilateral || shape == CellShape::hexahedron) return;
  for (const CellBlock& block : mesh.cells) {
    for (Index cell = 0; cell < block.size(); ++cell) {
      Matrix edges(mesh.dimension, mesh.dimension);
      for (int k = 0; k < mesh.dimension; ++k)
        edges.col(k) = mesh.nodes.col(block.cell(cell)[k + 1]) - mesh.nodes.col(block.cell(cell)[0]);
      EXPECT_GT(edges.determinant(), 0.0);
    }
  }
}

TEST(RefinedMesh, RefusesMoreCellsThanTheMachineHolds) {
  Mesh mesh = make_box_mesh(bent_box(CellShape::tetrahedron, 1));
  const Index before = mesh.cell_count();
  expect_error({"refined 16 times, the mesh would have "}, [&] { refine(mesh, 16); });
  EXPECT_EQ(mesh.cell_count(), before);
}

INSTANTIATE_TEST_SUITE_P(All, RefineMesh, testing::Combine(testing::ValuesIn(all_cell_shapes()), testing::Values(1, 2)),
                         [](const auto& info) {
                           return name(std::get<0>(info.param)) + std::to_string(std::get<1>(info.param));
                         });

}  // namespace ricochet::test_support::refine_mesh_test
