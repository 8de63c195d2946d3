#include <gtest/gtest.h>

#include <Eigen/LU>
#include <map>
#include <set>

#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/mesh/gmsh_elements.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "support.hpp"

/// Cells whose nodes are numbered in reverse orientation, as many programs write them.
namespace ricochet::test_support {
namespace {

/// Node permutation of the mirror image for each of Gmsh's element types, in Gmsh's numbering (reference manual, "Node
/// ordering"). These mirrors differ from the one with which the reader reorients cells.
const std::map<int, std::vector<std::size_t>>& mirror_images() {
  static const std::map<int, std::vector<std::size_t>> images{
      {2, {0, 2, 1}},
      {9, {0, 2, 1, 5, 4, 3}},
      {3, {1, 0, 3, 2}},
      {10, {1, 0, 3, 2, 4, 7, 6, 5, 8}},
      {4, {1, 0, 2, 3}},
      {11, {1, 0, 2, 3, 4, 6, 5, 9, 8, 7}},
      {5, {4, 5, 6, 7, 0, 1, 2, 3}},
      {12, {4, 5, 6, 7, 0, 1, 2, 3, 16, 17, 10, 18, 12, 19, 14, 15, 8, 9, 11, 13, 25, 21, 22, 23, 24, 20, 26}},
  };
  return images;
}

/// Reverses every `stride`-th cell.
gmsh::RawMesh with_reversed_cells(const std::string& name, std::size_t stride) {
  gmsh::RawMesh raw = gmsh::read_msh(mesh_content(name), name);
  const int dimension = gmsh::select_elements(raw, name).dimension;
  for (gmsh::RawElements& elements : raw.elements) {
    if (gmsh::find_element_type(elements.type)->dimension != dimension) continue;
    const std::vector<std::size_t>& image = mirror_images().at(elements.type);
    for (std::size_t cell = 0; cell < elements.tags.size(); cell += stride) {
      const auto first = elements.nodes.begin() + std::ptrdiff_t(cell * image.size());
      const std::vector<std::int64_t> nodes(first, first + std::ptrdiff_t(image.size()));
      for (std::size_t k = 0; k < image.size(); ++k) first[std::ptrdiff_t(k)] = nodes[image[k]];
    }
  }
  return raw;
}

/// Determinant of the edges of the reference axes at vertex 0.
double corner_determinant(const Mesh& mesh, const CellBlock& block, Index cell) {
  const int last = block.shape == CellShape::hexahedron ? 4 : 3;
  Matrix edges(mesh.dimension, mesh.dimension);
  for (int axis = 0; axis < mesh.dimension; ++axis) {
    const int end = axis == 2 ? last : axis + 1;
    edges.col(axis) = mesh.nodes.col(block.cell(cell)[end]) - mesh.nodes.col(block.cell(cell)[0]);
  }
  return edges.determinant();
}

std::set<std::int64_t> node_set(const Mesh& mesh, const CellBlock& block, Index cell) {
  std::set<std::int64_t> tags;
  for (int k = 0; k < block.nodes_per_cell; ++k) tags.insert(mesh.node_tags[std::size_t(block.cell(cell)[k])]);
  return tags;
}

TEST(ReversedCells, AreTurnedRound) {
  for (const std::string shape : {"triangle", "quadrilateral", "tetrahedron", "hexahedron", "mixed"}) {
    for (const std::string order : {"_o1_", "_o2_"}) {
      const std::string name = shape + order + "msh41_ascii.msh";
      const Mesh reference = read_test_mesh(name);
      for (const std::size_t stride : {1u, 3u}) {
        const gmsh::RawMesh raw = with_reversed_cells(name, stride);
        // Tangled cells would be refused: so all nodes, second-order ones included, are at their positions.
        const Mesh mesh = gmsh::build_mesh(raw, {name, 1.0, false, false});
        ASSERT_EQ(mesh.cells.size(), reference.cells.size());
        for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
          ASSERT_EQ(mesh.cells[b].tags, reference.cells[b].tags);
          for (Index cell = 0; cell < mesh.cells[b].size(); ++cell) {
            EXPECT_GT(corner_determinant(mesh, mesh.cells[b], cell), 0.0) << name;
            EXPECT_EQ(node_set(mesh, mesh.cells[b], cell), node_set(reference, reference.cells[b], cell)) << name;
          }
        }
        for (const Group& group : reference.groups)
          EXPECT_EQ(mesh.find_group(group.name, group.dimension)->members, group.members);
      }
    }
  }
}

/// Two cells of unit size that share the facet x = 1; the other vertices of the second one are at x = `far`.
gmsh::RawMesh two_cells(int type, double far, bool second_reversed) {
  gmsh::RawMesh raw;
  std::vector<std::vector<double>> points;
  std::vector<std::int64_t> first;
  std::vector<std::int64_t> second;
  switch (type) {
    case 2:
      points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {far, 0.3, 0}};
      first = {1, 2, 3};
      second = {4, 3, 2};
      break;
    case 3:
      points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {far, 0, 0}, {far, 1, 0}};
      first = {1, 2, 3, 4};
      second = {2, 5, 6, 3};
      break;
    case 4:
      points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 1}, {far, 0.2, 0.3}};
      first = {1, 2, 3, 4};
      second = {5, 2, 4, 3};
      break;
    default:
      points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},   {0, 1, 0},   {0, 0, 1},   {1, 0, 1},
                {1, 1, 1}, {0, 1, 1}, {far, 0, 0}, {far, 1, 0}, {far, 0, 1}, {far, 1, 1}};
      first = {1, 2, 3, 4, 5, 6, 7, 8};
      second = {2, 9, 10, 3, 6, 11, 12, 7};
  }
  if (second_reversed) {
    std::vector<std::int64_t> image;
    for (const std::size_t k : mirror_images().at(type)) image.push_back(second[k]);
    second = image;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    raw.node_tags.push_back(std::int64_t(i) + 1);
    raw.coordinates.insert(raw.coordinates.end(), points[i].begin(), points[i].end());
  }
  gmsh::RawElements cells;
  cells.type = type;
  cells.groups = {1};
  cells.tags = {41, 42};
  cells.nodes = first;
  cells.nodes.insert(cells.nodes.end(), second.begin(), second.end());
  raw.elements.push_back(cells);
  return raw;
}

TEST(ReversedCells, AreToldFromFoldedMeshes) {
  for (const int type : {2, 3, 4, 5}) {
    const auto refusal = [&](double far, bool second_reversed) {
      return message_of([&] {
        static_cast<void>(gmsh::build_mesh(two_cells(type, far, second_reversed), {"test.msh", 1.0, false, false}));
      });
    };
    EXPECT_EQ(refusal(1.7, false), "") << type;
    EXPECT_EQ(refusal(1.7, true), "") << type;
    // The second cell overlaps the first: its nodes are numbered as if it were beside it.
    const std::string message = refusal(0.4, false);
    EXPECT_TRUE(has(message, "folded")) << type << message;
    EXPECT_TRUE(has(message, "elements 41 and 42 at (1, ")) << type << message;
  }
}

TEST(ReversedCells, EveryFacetInsideTellsOnWhichSideItsCellsLie) {
  for (const std::string shape : {"triangle", "quadrilateral", "tetrahedron", "hexahedron", "mixed"}) {
    for (const std::string order : {"_o1_", "_o2_"}) {
      Mesh mesh = read_test_mesh(shape + order + "msh41_ascii.msh");
      EXPECT_TRUE(folded_facets(mesh.cells).empty()) << shape;
      std::map<std::pair<std::size_t, Index>, std::size_t> inside;
      for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
        for (Index cell = 0; cell < mesh.cells[b].size(); ++cell)
          inside[{b, cell}] = facet_nodes(mesh.cells[b].shape, 1).size();
      }
      for (const CellFacet& facet : boundary_facets(mesh.cells)) --inside[{facet.block, facet.cell}];
      for (const auto& [place, count] : inside) {
        CellBlock& block = mesh.cells[place.first];
        Index* nodes = block.nodes.data() + place.second * block.nodes_per_cell;
        const std::vector<Index> before(nodes, nodes + block.nodes_per_cell);
        const std::vector<int>& mirrored = mirrored_nodes(block.shape, mesh.degree);
        for (std::size_t k = 0; k < before.size(); ++k) nodes[k] = before[std::size_t(mirrored[k])];
        EXPECT_EQ(folded_facets(mesh.cells).size(), count) << shape;
        std::ranges::copy(before, nodes);
      }
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
