#include "ricochet/mesh/merge_parts.hpp"

#include <gtest/gtest.h>

#include <set>

#include "ricochet/mesh/derived_groups.hpp"
#include "support.hpp"

namespace ricochet::test_support {
namespace {

/// A cell or facet by the coordinates of its nodes in order, which identify it in any numbering.
using PlacedCell = std::vector<std::vector<double>>;

PlacedCell placed_cell(const Mesh& mesh, const std::vector<CellBlock>& blocks, Index number, double shift = 0.0) {
  const IndexInBlocks at = locate_in_blocks(blocks, number);
  PlacedCell result;
  for (int k = 0; k < blocks[at.block].nodes_per_cell; ++k) {
    const Vector position = mesh.nodes.col(blocks[at.block].cell(at.local)[k]);
    result.emplace_back(position.data(), position.data() + position.size());
    result.back()[0] += shift;
  }
  return result;
}

std::multiset<PlacedCell> placed_members(const Mesh& mesh, const Group& group, double shift = 0.0) {
  const std::vector<CellBlock>& blocks = group.dimension == mesh.dimension ? mesh.cells : mesh.facets;
  std::multiset<PlacedCell> result;
  for (const Index member : group.members) result.insert(placed_cell(mesh, blocks, member, shift));
  return result;
}

Mesh shifted_mesh(const std::string& name, double shift) {
  Mesh mesh = read_test_mesh(name);
  mesh.nodes.row(0).array() += shift;
  return mesh;
}

constexpr double apart = 16.0;

std::vector<NamedMesh> two_parts(const std::string& order, double shift = apart) {
  return {{"left", read_test_mesh("quadrilateral" + order + "msh41_ascii.msh")},
          {"right", shifted_mesh("mixed" + order + "msh41_ascii.msh", shift)}};
}

TEST(MergeParts, KeepsCellsFacetsAndGroupsOfEachPart) {
  for (const std::string order : {"_o1_", "_o2_"}) {
    const std::vector<NamedMesh> parts = two_parts(order);
    const Mesh mesh = merge_parts(parts);
    ASSERT_EQ(mesh.parts.size(), 2u);
    std::size_t groups = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Mesh& own = parts[i].mesh;
      const MeshPart& part = mesh.parts[i];
      EXPECT_EQ(part.name, parts[i].name);
      EXPECT_EQ(part.node_count, own.node_count());
      EXPECT_EQ(mesh.nodes.middleCols(part.first_node, part.node_count), own.nodes);
      EXPECT_EQ(Index(part.cells.size()), own.cell_count());
      EXPECT_TRUE(std::ranges::is_sorted(part.cells));
      std::multiset<PlacedCell> before, after;
      for (Index cell = 0; cell < own.cell_count(); ++cell) before.insert(placed_cell(own, own.cells, cell));
      for (const Index cell : part.cells) after.insert(placed_cell(mesh, mesh.cells, cell));
      EXPECT_EQ(after, before);
      for (const Group& group : own.groups) {
        const Group* const merged = mesh.find_group(part.name + "." + group.name, group.dimension);
        ASSERT_NE(merged, nullptr) << group.name;
        ++groups;
        EXPECT_EQ(merged->members.size(), group.members.size());
        EXPECT_TRUE(std::ranges::is_sorted(merged->members));
        if (group.dimension + 1 < own.dimension) continue;
        EXPECT_EQ(placed_members(mesh, *merged), placed_members(own, group)) << group.name;
      }
    }
    EXPECT_EQ(mesh.groups.size(), groups);
    std::set<std::pair<int, int>> tags;
    for (const Group& group : mesh.groups) EXPECT_TRUE(tags.insert({group.dimension, group.tag}).second) << group.name;
  }
}

TEST(MergeParts, HasOneBlockPerShapeInTheOrderOfShapes) {
  const Mesh mesh = merge_parts(two_parts("_o1_"));
  ASSERT_EQ(mesh.cells.size(), 2u);  // triangles of one part, quadrilaterals of both
  EXPECT_EQ(mesh.cells[0].shape, CellShape::triangle);
  EXPECT_EQ(mesh.cells[1].shape, CellShape::quadrilateral);
  ASSERT_EQ(mesh.facets.size(), 1u);
  for (const CellBlock& block : mesh.cells)
    EXPECT_EQ(block.nodes.size(), std::size_t(block.size() * block.nodes_per_cell));
}

TEST(MergeParts, NumbersForMessagesHaveThoseOfTheFileInTheirLastDigits) {
  std::vector<NamedMesh> parts = two_parts("_o1_");
  const auto numbers = [](const Mesh& mesh) {
    std::set<std::int64_t> cells;
    for (const CellBlock& block : mesh.cells) cells.insert(block.tags.begin(), block.tags.end());
    return cells;
  };
  Mesh mesh = merge_parts(parts);
  std::set<std::int64_t> expected = numbers(parts[0].mesh);
  for (const std::int64_t tag : numbers(parts[1].mesh)) expected.insert(tag + 1'000'000);
  EXPECT_EQ(numbers(mesh), expected);
  const auto first = std::size_t(parts[0].mesh.node_count());
  EXPECT_EQ(mesh.node_tags[0], parts[0].mesh.node_tags[0]);
  EXPECT_EQ(mesh.node_tags[first], parts[1].mesh.node_tags[0] + 1'000'000);
  // A number with as many digits as those of the first file.
  parts[0].mesh.node_tags[0] = 1'000'000;
  mesh = merge_parts(parts);
  EXPECT_EQ(mesh.node_tags[first], parts[1].mesh.node_tags[0] + 10'000'000);
  parts[0].mesh.node_tags[0] = std::numeric_limits<std::int64_t>::max() - 1;
  EXPECT_TRUE(has(message_of([&] { (void)merge_parts(parts); }), "Mesh.Renumber"));
}

TEST(MergeParts, FacetsThatNoFileHasStayWithoutNumber) {
  std::vector<NamedMesh> parts = two_parts("_o1_");
  add_built_in_group(parts[1].mesh, "boundary", 1);
  const Mesh mesh = merge_parts(parts);
  const Group& boundary = mesh.group("right.boundary", 1);
  const auto count = std::ranges::count_if(boundary.members, [&](Index facet) {
    const IndexInBlocks at = locate_in_blocks(mesh.facets, facet);
    return mesh.facets[at.block].tags[std::size_t(at.local)] == 0;
  });
  EXPECT_EQ(count, 8);  // 12 sides, of which 4 are in the group of the file
}

TEST(MergeParts, AllAndBoundaryOfAPartAreBuiltIn) {
  for (const std::string order : {"_o1_", "_o2_"}) {
    // At the same position as well, nothing is joined.
    for (const double shift : {apart, 0.0}) {
      std::vector<NamedMesh> parts = two_parts(order, shift);
      Mesh mesh = merge_parts(parts);
      for (const char* const name : {"right.boundary", "left.boundary", "boundary"}) add_built_in_group(mesh, name, 1);
      for (const char* const name : {"left.all", "all"}) add_built_in_group(mesh, name, 2);
      for (NamedMesh& part : parts) {
        add_built_in_group(part.mesh, "boundary", 1);
        EXPECT_EQ(placed_members(mesh, mesh.group(part.name + ".boundary", 1)),
                  placed_members(part.mesh, part.mesh.group("boundary", 1)));
      }
      EXPECT_EQ(mesh.group("boundary", 1).members.size(),
                mesh.group("left.boundary", 1).members.size() + mesh.group("right.boundary", 1).members.size());
      EXPECT_EQ(mesh.group("left.all", 2).members, mesh.parts[0].cells);
      EXPECT_EQ(mesh.group("all", 2).members.size(), std::size_t(mesh.cell_count()));
      // The file already has a group "all".
      EXPECT_EQ(placed_members(mesh, mesh.group("right.all", 2)),
                placed_members(parts[1].mesh, parts[1].mesh.group("all", 2)));
    }
  }
  const Mesh mesh = merge_parts(two_parts("_o1_"));
  EXPECT_TRUE(is_built_in_group(mesh, "left.all", 2));
  EXPECT_TRUE(is_built_in_group(mesh, "boundary", 1));
  EXPECT_FALSE(is_built_in_group(mesh, "left.all", 1));
  EXPECT_FALSE(is_built_in_group(mesh, "left.boundary", 2));
  EXPECT_FALSE(is_built_in_group(mesh, "middle.all", 2));
}

TEST(MergeParts, TheOrderIsThatOfTheParts) {
  std::vector<NamedMesh> parts = two_parts("_o1_");
  std::swap(parts[0], parts[1]);
  const Mesh mesh = merge_parts(parts);
  EXPECT_EQ(mesh.parts[0].name, "right");
  EXPECT_EQ(mesh.parts[0].first_node, 0);
  EXPECT_EQ(mesh.source, "parts \"right\" and \"left\"");
}

TEST(MergeParts, MissingGroupsAreExplained) {
  const Mesh mesh = merge_parts(two_parts("_o1_"));
  EXPECT_TRUE(has(message_of([&] { (void)mesh.group("bottom", 1); }),
                  "parts \"left\" and \"right\": there is no group \"bottom\" of boundary facets"));
  EXPECT_TRUE(has(message_of([&] { (void)mesh.group("bottom", 1); }),
                  "\"left.boundary\" those of part \"left\"; did you mean \"left.bottom\" or \"right.bottom\"?"));
  EXPECT_TRUE(has(message_of([&] { (void)mesh.group("left.botom", 1); }), "did you mean \"left.bottom\"?"));
}

TEST(MergeParts, RefusesPartsOfDifferentKinds) {
  const NamedMesh plane{"plane", read_test_mesh("triangle_o1_msh41_ascii.msh")},
      curved{"curved", read_test_mesh("triangle_o2_msh41_ascii.msh")},
      solid{"solid", read_test_mesh("tetrahedron_o1_msh41_ascii.msh")};
  EXPECT_EQ(mismatch_of_parts(plane, plane), "");
  const std::string degree = message_of([&] { (void)merge_parts({plane, curved}); });
  EXPECT_TRUE(degree.starts_with("part \"curved\" is a mesh of degree 2, part \"plane\" of degree 1: ")) << degree;
  EXPECT_TRUE(has(degree, "-order 1"));
  const std::string dimension = message_of([&] { (void)merge_parts({solid, plane}); });
  EXPECT_TRUE(dimension.starts_with("part \"plane\" is a mesh of dimension 2, part \"solid\" of dimension 3: "))
      << dimension;
}

}  // namespace
}  // namespace ricochet::test_support
