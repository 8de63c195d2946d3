#include "ricochet/mesh/derived_groups.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "ricochet/mesh/reference_cell.hpp"
#include "support.hpp"

namespace ricochet::test_support {
namespace {

using NodeSet = std::set<Index>;

NodeSet facet_at(const Mesh& mesh, Index number) {
  for (const CellBlock& block : mesh.facets) {
    if (number < block.size()) return {block.cell(number), block.cell(number) + block.nodes_per_cell};
    number -= block.size();
  }
  return {};
}

std::multiset<NodeSet> facets_of(const Mesh& mesh, const std::string& group) {
  std::multiset<NodeSet> result;
  for (const Index member : mesh.group(group, mesh.dimension - 1).members) result.insert(facet_at(mesh, member));
  return result;
}

/// Facets that occur once among those of all cells.
std::multiset<NodeSet> boundary_by_counting(const Mesh& mesh) {
  std::map<NodeSet, int> counts;
  for (const CellBlock& block : mesh.cells) {
    for (Index cell = 0; cell < block.size(); ++cell) {
      for (const std::vector<int>& local : facet_nodes(block.shape, mesh.degree)) {
        NodeSet nodes;
        for (const int node : local) nodes.insert(block.cell(cell)[node]);
        ++counts[nodes];
      }
    }
  }
  std::multiset<NodeSet> result;
  for (const auto& [nodes, count] : counts) {
    if (count == 1) result.insert(nodes);
  }
  return result;
}

TEST(DerivedGroups, BoundaryIsEveryFacetOfOneCell) {
  for (const std::string shape : {"triangle", "quadrilateral", "tetrahedron", "hexahedron", "mixed"}) {
    for (const std::string order : {"_o1_", "_o2_"}) {
      const Mesh before = read_test_mesh(shape + order + "msh41_ascii.msh");
      Mesh mesh = before;
      add_built_in_group(mesh, "boundary", mesh.dimension - 1);
      EXPECT_EQ(facets_of(mesh, "boundary"), boundary_by_counting(before)) << shape << order;
      for (const Group& group : before.groups) {
        if (group.dimension != mesh.dimension - 1 || group.members.empty()) continue;
        EXPECT_EQ(facets_of(mesh, group.name), facets_of(before, group.name)) << shape << order << group.name;
      }
    }
  }
}

// A tetrahedron beside a cube: the numbers of the squares move when triangles are added.
constexpr const char* two_shapes =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 1 \"face\"\n2 2 \"floor\"\n3 3 \"solids\"\n"
    "$EndPhysicalNames\n$Nodes\n12\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 3 0 0\n6 4 0 0\n7 4 1 0\n8 3 1 0\n9 3 0 1\n"
    "10 4 0 1\n11 4 1 1\n12 3 1 1\n$EndNodes\n$Elements\n4\n1 2 2 1 1 1 2 3\n2 3 2 2 2 5 6 7 8\n"
    "3 4 2 3 3 1 2 3 4\n4 5 2 3 3 5 6 7 8 9 10 11 12\n$EndElements\n";

TEST(DerivedGroups, FacetsOfTwoShapesKeepTheirGroups) {
  const Mesh before = mesh_of(two_shapes);
  Mesh mesh = before;
  add_built_in_group(mesh, "boundary", 2);
  EXPECT_EQ(mesh.group("boundary", 2).members.size(), 10u);  // 4 triangles and 6 squares
  EXPECT_EQ(mesh.facet_count(), 10);
  EXPECT_EQ(facets_of(mesh, "boundary"), boundary_by_counting(before));
  EXPECT_EQ(facets_of(mesh, "face"), facets_of(before, "face"));
  EXPECT_EQ(facets_of(mesh, "floor"), facets_of(before, "floor"));
}

TEST(DerivedGroups, AllIsEveryCellAndAGroupOfTheFileComesFirst) {
  Mesh mesh = mesh_of(two_shapes);
  add_built_in_group(mesh, "all", 3);
  EXPECT_EQ(mesh.group("all", 3).members, mesh.group("solids", 3).members);
  EXPECT_EQ(mesh.find_group("all", 2), nullptr);
  Mesh named = mesh_of(replaced(two_shapes, "\"floor\"", "\"boundary\""));
  add_built_in_group(named, "boundary", 2);
  EXPECT_EQ(named.group("boundary", 2).members.size(), 1u);
}

TEST(DerivedGroups, UnionsHaveNoDuplicates) {
  Mesh mesh = mesh_of(two_shapes);
  add_built_in_group(mesh, "boundary", 2);
  add_union_of_groups(mesh, "[face, boundary, floor]", {"face", "boundary", "floor"}, 2);
  EXPECT_EQ(mesh.group("[face, boundary, floor]", 2).members, mesh.group("boundary", 2).members);
  add_union_of_groups(mesh, "[floor, face]", {"floor", "face"}, 2);
  EXPECT_EQ(mesh.group("[floor, face]", 2).members.size(), 2u);
}

// As gmsh saves a mesh without physical groups: all elements, by entity.
TEST(DerivedGroups, AMeshWithoutGroupsHasThoseOfItsEntities) {
  const TemporaryDirectory directory;
  std::string text = two_shapes;
  text = replaced(text, "$PhysicalNames\n3\n2 1 \"face\"\n2 2 \"floor\"\n3 3 \"solids\"\n$EndPhysicalNames\n", "");
  text = replaced(text, "1 2 2 1 1 1", "1 2 2 0 7 1");
  text = replaced(text, "2 3 2 2 2 5", "2 3 2 0 9 5");
  text = replaced(text, "3 4 2 3 3 1", "3 4 2 0 1 1");
  const std::string one_volume = replaced(text, "4 5 2 3 3 5", "4 5 2 0 1 5");
  const std::string two_volumes = replaced(text, "4 5 2 3 3 5", "4 5 2 0 4 5");
  Mesh mesh = read_mesh(mesh_file(directory.write("one.msh", one_volume)));
  EXPECT_EQ(mesh.group("body", 3).members.size(), 2u);
  EXPECT_EQ(mesh.group("surface 7", 2).members.size(), 1u);
  EXPECT_EQ(mesh.group("surface 9", 2).members.size(), 1u);
  EXPECT_EQ(mesh.find_group("volume 1", 3), nullptr);
  mesh = read_mesh(mesh_file(directory.write("two.msh", two_volumes)));
  EXPECT_EQ(mesh.group("body", 3).members.size(), 2u);
  EXPECT_EQ(mesh.group("volume 1", 3).members, std::vector<Index>{0});
  EXPECT_EQ(mesh.group("volume 4", 3).members, std::vector<Index>{1});
}

}  // namespace
}  // namespace ricochet::test_support
