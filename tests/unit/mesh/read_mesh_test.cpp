#include "ricochet/mesh/read_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "support.hpp"
#include "support/errors.hpp"

namespace ricochet::test_support {
namespace {

using CellByNodes = std::vector<std::int64_t>;

/// Cells and facets of every group as sets of node tags, which do not depend on the dialect of the file.
std::map<std::string, std::set<CellByNodes>> content_by_group(const Mesh& mesh) {
  std::map<std::string, std::set<CellByNodes>> result;
  const auto add = [&](const std::string& key, const std::vector<CellBlock>& blocks, Index number) {
    for (const CellBlock& block : blocks) {
      if (number >= block.size()) {
        number -= block.size();
        continue;
      }
      CellByNodes tags;
      for (int k = 0; k < block.nodes_per_cell; ++k) {
        tags.push_back(mesh.node_tags[std::size_t(block.cell(number)[k])]);
      }
      std::ranges::sort(tags);
      result[key].insert(tags);
      return;
    }
    FAIL() << "group member out of range";
  };
  for (Index i = 0; i < mesh.cell_count(); ++i) add("all cells", mesh.cells, i);
  for (const Group& group : mesh.groups) {
    result[group.name + "/" + std::to_string(group.dimension)];
    const auto& blocks = group.dimension == mesh.dimension ? mesh.cells : mesh.facets;
    for (const Index member : group.members) add(group.name + "/" + std::to_string(group.dimension), blocks, member);
  }
  return result;
}

TEST(ReadMesh, AllDialectsGiveTheSameMesh) {
  for (const std::string shape : {"triangle", "quadrilateral", "tetrahedron", "hexahedron", "mixed"}) {
    for (const std::string order : {"_o1_", "_o2_"}) {
      const Mesh reference = read_test_mesh(shape + order + "msh41_binary.msh");
      for (const std::string dialect : {"msh22_ascii", "msh22_binary", "msh41_ascii"}) {
        const Mesh mesh = read_test_mesh(shape + order + dialect + ".msh");
        EXPECT_EQ(mesh.dimension, reference.dimension);
        ASSERT_EQ(mesh.node_tags, reference.node_tags);
        EXPECT_LT((mesh.nodes - reference.nodes).cwiseAbs().maxCoeff(), 1e-14);
        EXPECT_EQ(content_by_group(mesh), content_by_group(reference)) << shape << order << dialect;
      }
    }
  }
}

TEST(ReadMesh, GroupsAreThoseOfTheGeometry) {
  const Mesh mesh = read_test_mesh("triangle_o1_msh41_ascii.msh");
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.degree, 1);
  EXPECT_EQ(mesh.group("body", 2).members.size(), std::size_t(mesh.cell_count()));
  EXPECT_EQ(mesh.group("7", 1).tag, 7);  // an unnamed group
  EXPECT_NE(mesh.find_group("corner", 0), nullptr);
  EXPECT_EQ(mesh.find_group("corner", 1), nullptr);
  std::size_t facets = 0;
  for (const char* name : {"bottom", "sides", "7"}) facets += mesh.group(name, 1).members.size();
  EXPECT_EQ(facets, std::size_t(mesh.facet_count()));
}

TEST(ReadMesh, CellsInTwoGroupsAreThereOnce) {
  for (const std::string dialect : {"msh22_ascii", "msh22_binary", "msh41_ascii", "msh41_binary"}) {
    const Mesh mesh = read_test_mesh("mixed_o2_" + dialect + ".msh");
    EXPECT_EQ(mesh.cell_count(), 12);
    EXPECT_EQ(mesh.cells.size(), 2u);
    EXPECT_EQ(mesh.group("all", 2).members.size(), 12u);
    EXPECT_EQ(mesh.group("left half", 2).members.size(), 8u);
    EXPECT_EQ(mesh.facet_count(), 6);
    EXPECT_EQ(mesh.group("bottom", 1).members.size(), 4u);
    EXPECT_EQ(mesh.group("bottom left", 1).members.size(), 2u);
    EXPECT_EQ(mesh.group("interface", 1).members.size(), 2u);
  }
}

TEST(ReadMesh, ParametricCoordinatesAreSkipped) {
  const Mesh reference = read_test_mesh("triangle_o1_msh41_binary.msh");
  for (const char* name : {"parametric_ascii.msh", "parametric_binary.msh"}) {
    const Mesh mesh = read_test_mesh(name);
    ASSERT_EQ(mesh.node_tags, reference.node_tags);
    EXPECT_LT((mesh.nodes - reference.nodes).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(ReadMesh, CurvedBoundaryNodesLieOnTheCircle) {
  const Mesh mesh = read_test_mesh("disc_o2_msh41_binary.msh");
  ASSERT_EQ(mesh.facets.size(), 1u);
  ASSERT_EQ(mesh.group("boundary", 1).members.size(), std::size_t(mesh.facet_count()));
  for (const Index node : mesh.facets[0].nodes) EXPECT_NEAR(mesh.nodes.col(node).norm(), 1.0, 1e-9);
}

TEST(ReadMesh, ScalingByAPowerOfTwoIsExact) {
  for (const char* name :
       {"triangle_o1_msh22_ascii.msh", "tetrahedron_o2_msh41_binary.msh", "hexahedron_o2_msh22_binary.msh"}) {
    const Mesh mesh = read_test_mesh(name);
    for (const int exponent : {-60, -10, 7, 80}) {
      MeshFile file = mesh_file(mesh_path(name));
      file.scale = std::ldexp(1.0, exponent);
      const Mesh scaled = read_mesh(file);
      EXPECT_TRUE((scaled.nodes.array() == mesh.nodes.array() * file.scale).all()) << name << exponent;
      EXPECT_EQ(scaled.cells[0].nodes, mesh.cells[0].nodes);
    }
  }
}

TEST(ReadMesh, MissingGroupsAreExplained) {
  const Mesh mesh = read_test_mesh("mixed_o1_msh41_ascii.msh");
  const std::string misspelt = message_of([&] { (void)mesh.group("botom", 1); });
  EXPECT_TRUE(has(misspelt, "did you mean \"bottom\"?"));
  EXPECT_TRUE(has(misspelt, "\"interface\""));
  EXPECT_TRUE(has(misspelt, "mixed_o1_msh41_ascii.msh"));
  const std::string other = message_of([&] { (void)mesh.group("left half", 1); });
  EXPECT_TRUE(has(other, "\"left half\" is a group of cells"));
  const std::string empty = message_of([&] { (void)mesh.group("nothing", 1); });
  EXPECT_TRUE(has(empty, "\"nothing\" of boundary facets is empty"));
}

TEST(ReadMesh, RequestsAreChecked) {
  const auto message = [](auto change) {
    MeshFile file = mesh_file(mesh_path("triangle_o1_msh41_ascii.msh"));
    change(file);
    return message_of([&] { (void)read_mesh(file); });
  };
  EXPECT_TRUE(has(message([](MeshFile& file) { file.scale = 0.0; }), "scale"));
  EXPECT_TRUE(has(message([](MeshFile& file) { file.scale = -1.0; }), "scale"));
  EXPECT_TRUE(has(message([](MeshFile& file) { file.scale = NAN; }), "scale"));
  EXPECT_TRUE(has(message([](MeshFile& file) { file.scale = INFINITY; }), "scale"));
  EXPECT_TRUE(has(message([](MeshFile& file) { file.size = 0.1; }), "size"));
  EXPECT_TRUE(has(message([](MeshFile& file) { file.geometry_degree = 3; }), "degree"));
  EXPECT_NE(message([](MeshFile& file) { file.scale = 1e308; }), "");
}

TEST(ReadMesh, FilesThatCannotBeReadHaveTheirOwnKind) {
  expect_error(ErrorKind::file_access, {"directory"}, [] { (void)read_mesh(mesh_file(mesh_path(""))); });
  expect_error(ErrorKind::file_access, {}, [&] { (void)read_mesh(mesh_file("/nonexistent/mesh.msh")); });
  expect_error(ErrorKind::file_access, {}, [&] { (void)read_mesh(mesh_file("/nonexistent/geometry.geo")); });
}

TEST(ReadMesh, UnusedNodesAreLeftOut) {
  const std::string content =
      replaced(mesh_content("triangle_o1_msh22_ascii.msh"), "$Nodes\n11\n", "$Nodes\n12\n5000 9 9 9\n");
  const Mesh mesh = mesh_of(content);
  EXPECT_EQ(mesh.node_count(), 11);
  EXPECT_EQ(std::ranges::count(mesh.node_tags, 5000), 0);
}

TEST(ReadMesh, SectionsWithoutMeaningHereAreSkipped) {
  const std::string extra = "$Comments\n$Nodes of any kind\n$EndComments\n";
  for (const std::string name : {"triangle_o1_msh22_ascii.msh", "triangle_o1_msh41_binary.msh"}) {
    const std::string content = mesh_content(name);
    EXPECT_EQ(mesh_of(extra + content).cell_count(), 11);
    EXPECT_EQ(mesh_of(content + "$NodeData\n1\n\"x\"\n$EndNodeData\n").cell_count(), 11);
  }
}

TEST(ReadMesh, LineEndsOfWindowsAreUnderstood) {
  for (const std::string name : {"triangle_o1_msh22_ascii.msh", "tetrahedron_o2_msh41_ascii.msh"}) {
    std::string content;
    for (const char c : mesh_content(name)) content += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(content_by_group(mesh_of(content)), content_by_group(mesh_of(mesh_content(name))));
  }
}

TEST(ReadMesh, WithoutEntitiesThereAreNoMembers) {
  std::string content = mesh_content("triangle_o1_msh41_ascii.msh");
  const std::size_t start = content.find("$Entities");
  content.erase(start, content.find("$Nodes") - start);
  const Mesh mesh = mesh_of(content);
  EXPECT_EQ(mesh.cell_count(), 11);
  EXPECT_EQ(mesh.facet_count(), 0);
  EXPECT_TRUE(mesh.find_group("body", 2)->members.empty());
}

TEST(ReadMesh, SparseNodeNumbersAreUnderstood) {
  const char* square =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 5\n7000000 1 0 5\n20000000 1 1 5\n900000000 0 1 5\n"
      "$EndNodes\n$Elements\n1\n5 3 0 1 7000000 20000000 900000000\n$EndElements\n";
  const Mesh mesh = mesh_of(square);
  EXPECT_EQ(mesh.cell_count(), 1);
  EXPECT_EQ(mesh.node_tags, (std::vector<std::int64_t>{1, 7000000, 20000000, 900000000}));
  EXPECT_EQ(mesh.cells[0].nodes, (std::vector<Index>{0, 1, 3, 2}));
}

}  // namespace
}  // namespace ricochet::test_support
