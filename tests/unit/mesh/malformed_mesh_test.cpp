#include <gtest/gtest.h>

#include <cstring>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

#include "ricochet/base/log.hpp"
#include "support.hpp"
#include "support/sanitized.hpp"

namespace ricochet::test {
namespace {

// Two triangles that make the unit square, one group of cells, and its lower side.
const char* const square_22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n2\n1 1 \"low\"\n2 2 \"body\"\n$EndPhysicalNames\n"
    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
    "$Elements\n3\n1 1 2 1 1 1 2\n2 2 2 2 1 1 2 3\n3 2 2 2 1 1 3 4\n$EndElements\n";

const char* const square_41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n2\n1 1 \"low\"\n2 2 \"body\"\n$EndPhysicalNames\n"
    "$Entities\n0 1 1 0\n6 0 0 0 1 0 0 1 1 0\n9 0 0 0 1 1 0 1 2 0\n$EndEntities\n"
    "$Nodes\n1 4 1 4\n2 9 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
    "$Elements\n2 3 1 3\n1 6 1 1\n1 1 2\n2 9 2 2\n2 1 2 3\n3 1 3 4\n$EndElements\n";

// One tetrahedron and one of its faces.
const char* const tetrahedron_22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$Nodes\n4\n11 0 0 0\n12 1 0 0\n13 0 1 0\n14 0 0 1\n$EndNodes\n"
    "$Elements\n2\n1 2 2 1 1 11 12 13\n2 4 2 1 1 11 12 13 14\n$EndElements\n";

struct Case {
  const char* base;
  const char* what;  ///< text to be replaced
  const char* by;
  const char* expected;  ///< part of the message
};

const Case cases[] = {
    // the file's frame
    {square_22, "2.2 0 8", "1 0 8", "version 1 of Gmsh's format; save the mesh as version 4.1 or 2.2"},
    {square_22, "2.2 0 8", "4 0 8", "version 4 of Gmsh's format"},
    {square_22, "2.2 0 8", "2.2 0 4", "test.msh:2: the data size is 4"},
    {square_22, "2.2 0 8", "2.2 2 8", "the file type is 2"},
    {square_22, "2.2 0 8", "2.2 1 8", "byte order"},
    {square_22, "2.2 0 8", "two 0 8", "\"two\" where the format's version should be"},
    {square_22, "$EndMeshFormat", "$EndFormat", "$EndMeshFormat should be here"},
    {square_22, "$MeshFormat", "MeshFormat", "not a Gmsh .msh file"},
    {square_22, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "", "$PhysicalNames precedes $MeshFormat"},
    {square_22, "$MeshFormat\n2.2 0 8\n$EndMeshFormat", "$NOD", "version 1"},
    {square_22, "$EndNodes\n", "$EndNodes\nstray\n", "a section ($Name) should start here"},
    {square_22, "$EndNodes\n", "$EndNodes\n$Other\n", "$Other is not followed by $EndOther"},
    {square_22, "$EndNodes\n", "$EndNodes\n$Nodes\n0\n$EndNodes\n", "the section $Nodes occurs twice"},
    {square_22, "$EndNodes\n", "$EndNodes\n$PartitionedEntities\n", "partitioned"},
    {square_22, "$EndNodes\n", "$EndNodes\n$ParametricNodes\n", "Mesh.SaveParametric"},
    {square_22, "$EndNodes\n", "", "$EndNodes should be here"},
    {square_22, "$EndElements\n", "", "the file ends before $EndElements"},
    // names
    {square_22, "1 1 \"low\"", "1 1 low", "in double quotes"},
    {square_22, "1 1 \"low\"", "2 2 \"low\"", "physical group 2 of dimension 2 is named twice"},
    {square_22, "1 1 \"low\"", "2 1 \"body\"", "physical groups 1 and 2 of dimension 2 are both called \"body\""},
    {square_22, "1 1 \"low\"", "5 1 \"low\"", "a physical group has the invalid dimension 5"},
    {square_22, "$PhysicalNames\n2", "$PhysicalNames\n-2", "the number of physical names is negative (-2)"},
    // nodes
    {square_22, "$Nodes\n4", "$Nodes\n-4", "test.msh:10: the number of nodes is negative (-4)"},
    {square_22, "$Nodes\n4", "$Nodes\n4000000000000", "the number of nodes is 4000000000000, which the remaining"},
    {square_22, "$Nodes\n4", "$Nodes\n99999999999999999999", "should be; it is not a whole number"},
    {square_22, "$Nodes\n4", "$Nodes\n3", "$EndNodes should be here"},
    {square_22, "$Nodes\n4", "$Nodes\n5", "\"$EndNodes\" where a node's number should be"},
    {square_22, "3 1 1 0\n", "3 1 1\n", "test.msh:13: the line ends where a node's coordinate should be"},
    {square_22, "3 1 1 0\n", "3 1 1 0 0\n", "the line should end before \"0\""},
    {square_22, "3 1 1 0\n", "3 1 1,0 0\n", "\"1,0\" where a node's coordinate should be; it is not a number"},
    {square_22, "3 1 1 0\n", "3 1 nan 0\n", "coordinates are not finite at node 3"},
    {square_22, "3 1 1 0\n", "3 1 1e999 0\n", "coordinates are not finite at node 3"},
    {square_22, "3 1 1 0\n", "2 1 1 0\n", "defined more than once in $Nodes: node 2"},
    {square_22, "3 1 1 0\n", "-3 1 1 0\n", "node numbers must be positive; found node -3"},
    {square_22, "3 1 1 0\n", "3 1 1 0.5\n", "plane z = constant"},
    {square_22, "4 0 1 0\n", "4 1 1 0\n", "degenerate cells, whose Jacobian vanishes: element 3"},
    {square_22, "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n", "$Nodes\n0\n", "the mesh has no nodes"},
    // elements
    {square_22, "$Elements\n3", "$Elements\n2", "$EndElements should be here"},
    {square_22, "$Elements\n3", "$Elements\n1000000", "the number of elements is 1000000, which the remaining"},
    {square_22, "$Elements\n3\n1 1 2 1 1 1 2\n2 2 2 2 1 1 2 3\n3 2 2 2 1 1 3 4\n", "$Elements\n0\n",
     "the mesh has no elements"},
    {square_22, "$Elements\n3\n1 1 2 1 1 1 2\n2 2 2 2 1 1 2 3\n3 2 2 2 1 1 3 4\n", "$Elements\n1\n1 1 2 1 1 1 2\n",
     "the mesh has 1 element, but none of dimension 2 or 3"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 2 2 2 1 1 2\n",
     "test.msh:19: the line ends where a node of an element should be"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 2 2 2 1 1 2 3 4\n", "the line should end before \"4\""},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 2 2 2 1 1 2 77\n", "element 2 refers to nodes that are not in $Nodes: node 77"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 2 -1 2 1 1 2 3\n", "element 2 has an invalid number of tags, -1"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 200 2 2 1 1 2 3\n", "type 200 (unknown to Ricochet)"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 34 2 2 1 1 2 3\n", "type 34 (polygon)"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 6 2 2 1 1 2 3 4 1 2\n", "1 element of type 6 (6-node prism)"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 7 2 2 1 1 2 3 4 1\n", "1 element of type 7 (5-node pyramid)"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 16 2 2 1 1 2 3 4 1 2 3 4\n",
     "type 16 (8-node quadrilateral); set Mesh.SecondOrderIncomplete = 0"},
    {square_22, "2 2 2 2 1 1 2 3\n", "3 2 2 2 1 1 2 3\n",
     "element numbers must be unique; found more than once: element 3"},
    {square_22, "2 2 2 2 1 1 2 3\n", "0 2 2 2 1 1 2 3\n", "element numbers must be positive; found element 0"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 2 2 2 1 1 2 2\n", "degenerate cells"},
    {square_22, "3 2 2 2 1 1 3 4\n", "3 2 2 2 1 1 2 3\n", "element 2: repeated in the group \"body\""},
    {square_22, "3 2 2 2 1 1 3 4\n", "3 2 2 0 1 1 2 3\n", "element 3 has the same vertices as another element"},
    {square_22, "1 1 2 1 1 1 2\n", "1 1 2 1 1 2 4\n",
     "in the group \"low\", line element 1 is not on the boundary of any cell"},
    {square_22, "1 1 2 1 1 1 2\n", "1 8 2 1 1 1 2 3\n", "the mesh has elements of first and second order"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 2 2 -2147483648 1 1 2 3\n", "physical group -2147483648"},
    {square_22, "2 2 2 2 1 1 2 3\n", "2 2 2 99999999999 1 1 2 3\n", "out of range"},
    {tetrahedron_22, "14 0 0 1", "14 0.5 0.5 0", "degenerate cells"},
    // format 4.1
    {square_41, "9 0 0 0 1 1 0 1 2 0\n", "9 0 0 0 1 1 0 1 2 3\n",
     "the line ends where an entity's bounding entity should be"},
    {square_41, "$Nodes\n1 4 1 4", "$Nodes\n1 5 1 4",
     "the blocks contain 4 nodes, but the head of the section announces 5"},
    {square_41, "$Nodes\n1 4 1 4", "$Nodes\n2 4 1 4", "where the dimension of a node block's entity should be"},
    {square_41, "$Nodes\n1 4 1 4", "$Nodes\n1 18446744073709551615 1 4", "should be; it is not a whole number"},
    {square_41, "$Nodes\n1 4 1 4", "$Nodes\n1 4", "the line ends where the smallest tag should be"},
    {square_41, "2 9 0 4\n", "2 9 7 4\n", "parametric flag 7"},
    {square_41, "2 9 0 4\n", "2 9 0 4000\n", "the number of nodes of a block is 4000, which the remaining"},
    {square_41, "2 9 0 4\n", "2 9 1 4\n", "the line ends where a node's parametric coordinate should be"},
    {square_41, "$Elements\n2 3 1 3", "$Elements\n2 4 1 3",
     "the blocks contain 3 elements, but the head of the section announces 4"},
    {square_41, "2 9 2 2\n", "2 8 2 2\n", "dimension 2 and tag 8, which is not in $Entities"},
    {square_41, "2 9 2 2\n", "1 6 2 2\n", "type 2 (3-node triangle) are on an entity of dimension 1"},
    {square_41, "2 9 2 2\n", "2 9 34 2\n", "2 elements of type 34 (polygon)"},
    {square_41, "0 1 1 0\n", "0 2 0 0\n", "dimension 2 and tag 9, which is not in $Entities"},
    {square_41, "0 1 1 0\n", "0 1 9000 0\n", "the number of entities of a dimension is 9000"},
    {square_41, "1 1 0 1 2 0\n$EndEntities", "1 1 0 1 0 0\n$EndEntities",
     "an entity is in the invalid physical group 0"},
    {square_41, "$EndEntities\n", "$EndEntities\n$Entities\n0 0 0 0\n$EndEntities\n",
     "the section $Entities occurs twice"},
};

TEST(MalformedMesh, TheBasesAreWellFormed) {
  EXPECT_EQ(mesh_of(square_22).group("low", 1).members.size(), 1u);
  EXPECT_EQ(mesh_of(square_41).group("body", 2).members.size(), 2u);
  EXPECT_EQ(mesh_of(tetrahedron_22).facet_count(), 1);
}

TEST(MalformedMesh, MessagesSayWhatIsWrong) {
  log::set_level(log::Level::off);
  for (const Case& one : cases) {
    const std::string content = replaced(one.base, one.what, one.by);
    const std::string message = message_of([&] { (void)mesh_of(content); });
    EXPECT_NE(message.find(one.expected), std::string::npos) << one.what << " -> " << one.by << "\n  said: " << message;
    EXPECT_TRUE(message.starts_with("test.msh:")) << message;
  }
  log::set_level(log::Level::info);
}

TEST(MalformedMesh, EmptyFilesAreRefused) {
  EXPECT_NE(message_of([] { (void)mesh_of(""); }).find("empty"), std::string::npos);
  EXPECT_NE(message_of([] { (void)mesh_of(" \n\n"); }).find("empty"), std::string::npos);
  EXPECT_NE(message_of([] { (void)mesh_of(std::string(1000, '\0')); }).find("not a Gmsh"), std::string::npos);
}

TEST(MalformedMesh, CoincidentNodesAreNamed) {
  const std::string content =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 2e-11 0\n6 1 1 "
      "0\n$EndNodes\n"
      "$Elements\n2\n1 2 0 1 2 3\n2 2 0 5 6 4\n$EndElements\n";
  for (const double scale : {1.0, std::ldexp(1.0, -40), std::ldexp(1.0, 40)}) {
    const std::string message = message_of([&] { (void)mesh_of(content, scale); });
    EXPECT_NE(message.find("2 pairs of nodes are at the same position: 1 and 5, 3 and 6"), std::string::npos)
        << message;
    EXPECT_EQ(mesh_of(content, scale, true).node_count(), 6);
  }
}

TEST(MalformedMesh, ThinCellsAreNotDegenerate) {
  const std::string content =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1e-8 0\n4 0 1e-8 0\n$EndNodes\n"
      "$Elements\n1\n1 3 0 1 2 3 4\n$EndElements\n";
  EXPECT_EQ(mesh_of(content).cell_count(), 1);
}

TEST(MalformedMesh, TangledCellsAreNamed) {
  // A quadrilateral with a corner pushed inside: its determinant is negative at that corner only.
  const std::string dart =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0.2 0.2 0\n4 0 1 0\n$EndNodes\n"
      "$Elements\n1\n1 3 0 1 2 3 4\n$EndElements\n";
  EXPECT_NE(message_of([&] { (void)mesh_of(dart); }).find("tangled cells, whose Jacobian changes sign: element 1"),
            std::string::npos);
  // A second-order triangle whose middle node lies beyond the opposite edge's.
  const std::string bent =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0.5 0.6 0\n5 0.5 0.5 0\n6 0 0.5 "
      "0\n$EndNodes\n"
      "$Elements\n1\n1 9 0 1 2 3 4 5 6\n$EndElements\n";
  EXPECT_NE(message_of([&] { (void)mesh_of(bent); }).find("tangled cells"), std::string::npos);
}

TEST(MalformedMesh, UnsupportedElementsOfGmshFilesAreCounted) {
  const auto message = [](const char* name) { return message_of([&] { (void)read_test_mesh(name); }); };
  EXPECT_NE(
      message("serendipity.msh").find("4 elements of type 17 (20-node hexahedron); set Mesh.SecondOrderIncomplete = 0"),
      std::string::npos);
  EXPECT_NE(message("third_order.msh").find("11 elements of type 21 (10-node triangle)"), std::string::npos);
  EXPECT_NE(message("partitioned.msh").find("partitioned"), std::string::npos);
}

TEST(MalformedMesh, HugeCountsInBinaryFilesAreRefusedBeforeAllocation) {
  std::string content = mesh_content("triangle_o1_msh41_binary.msh");
  const std::size_t place = content.find("$Nodes\n") + 7;
  const std::uint64_t huge = 1ull << 62;
  std::memcpy(content.data() + place + 8, &huge, sizeof huge);
  const std::string message = message_of([&] { (void)mesh_of(content); });
  EXPECT_NE(message.find("the number of nodes is 4611686018427387904, which the remaining"), std::string::npos)
      << message;
  EXPECT_NE(message.find("test.msh: byte "), std::string::npos) << message;
}

TEST(MalformedMesh, TheOtherByteOrderIsRefused) {
  std::string content = mesh_content("triangle_o1_msh41_binary.msh");
  const std::size_t place = content.find("8\n") + 2;
  std::reverse(content.begin() + static_cast<std::ptrdiff_t>(place),
               content.begin() + static_cast<std::ptrdiff_t>(place) + 4);
  EXPECT_NE(message_of([&] { (void)mesh_of(content); }).find("opposite byte order"), std::string::npos);
}

const char* const dialects[] = {"msh22_ascii", "msh22_binary", "msh41_ascii", "msh41_binary"};

TEST(MalformedMesh, EveryTruncationIsAnError) {
  log::set_level(log::Level::off);
  for (const std::string dialect : dialects) {
    for (const std::string shape : {"triangle_o1_", "mixed_o2_", "hexahedron_o1_"}) {
      const std::string content = mesh_content(shape + dialect + ".msh");
      const std::size_t end = content.find_last_not_of(" \n") + 1;
      for (std::size_t size = 0; size < end; ++size) {
        EXPECT_THROW((void)mesh_of(content.substr(0, size)), Error) << shape << dialect << " cut at " << size;
      }
    }
  }
  log::set_level(log::Level::info);
}

/// One test for each quarter of each file: under the sanitizers, which it is made for, all of them take minutes.
class DamagedMesh : public testing::TestWithParam<std::tuple<std::string, std::string, int>> {};
constexpr int parts = 4;

TEST_P(DamagedMesh, FlippedBitsGiveAMeshOrAnError) {
  log::set_level(log::Level::off);
  const auto& [shape, dialect, part] = GetParam();
  const std::string content = mesh_content(shape + '_' + dialect + ".msh");
  std::size_t places = 0, refused = 0;
  constexpr std::size_t stride = test::is_sanitized ? 5 * parts : parts;
  for (auto place = static_cast<std::size_t>(part); place < content.size(); place += stride) {
    ++places;
    for (const int flip : {0x01, 0x04, 0x20, 0x80, 0xff}) {
      std::string damaged = content;
      damaged[place] = static_cast<char>(damaged[place] ^ flip);
      try {
        (void)mesh_of(damaged);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, places);
  log::set_level(log::Level::info);
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedMesh,
    testing::Combine(testing::ValuesIn(std::vector<std::string>{"triangle_o1", "quadrilateral_o2", "hexahedron_o1"}),
                     testing::ValuesIn(std::vector<std::string>(std::begin(dialects), std::end(dialects))),
                     testing::Range(0, parts)),
    [](const auto& parameter) {
      return std::get<0>(parameter.param) + '_' + std::get<1>(parameter.param) + '_' +
             std::to_string(std::get<2>(parameter.param));
    });

}  // namespace
}  // namespace ricochet::test
