#include <gtest/gtest.h>

#include <cstring>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "ricochet/base/log.hpp"
#include "support.hpp"
#include "support/message_table.hpp"
#include "support/sanitized.hpp"

namespace ricochet::test_support {
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

class MalformedMeshFile : public testing::TestWithParam<MessageRow> {};

TEST_P(MalformedMeshFile, IsRefusedWithTheMessage) {
  const std::map<std::string, std::string> bases{
      {"square_22", square_22}, {"square_41", square_41}, {"tetrahedron_22", tetrahedron_22}};
  const std::vector<std::string>& cells = GetParam().cells;
  const log::Silence silence;
  const std::string content = replaced(bases.at(cells.at(0)), cells.at(1), cells.at(2));
  const std::string message = expect_error({cells.at(3)}, [&] { (void)mesh_of(content); });
  EXPECT_TRUE(message.starts_with("test.msh:")) << message;
}

INSTANTIATE_TEST_SUITE_P(All, MalformedMeshFile, testing::ValuesIn(read_messages("malformed_mesh.txt")), name_of_row);

TEST(MalformedMesh, TheBasesAreWellFormed) {
  EXPECT_EQ(mesh_of(square_22).group("low", 1).members.size(), 1u);
  EXPECT_EQ(mesh_of(square_41).group("body", 2).members.size(), 2u);
  EXPECT_EQ(mesh_of(tetrahedron_22).facet_count(), 1);
}

TEST(MalformedMesh, EmptyFilesAreRefused) {
  EXPECT_TRUE(has(message_of([] { (void)mesh_of(""); }), "empty"));
  EXPECT_TRUE(has(message_of([] { (void)mesh_of(" \n\n"); }), "empty"));
  EXPECT_TRUE(has(message_of([] { (void)mesh_of(std::string(1000, '\0')); }), "not a Gmsh"));
}

TEST(MalformedMesh, CoincidentNodesAreNamed) {
  const std::string content =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 2e-11 0\n6 1 1 "
      "0\n$EndNodes\n"
      "$Elements\n2\n1 2 0 1 2 3\n2 2 0 5 6 4\n$EndElements\n";
  for (const double scale : {1.0, std::ldexp(1.0, -40), std::ldexp(1.0, 40)}) {
    const std::string message = message_of([&] { (void)mesh_of(content, scale); });
    EXPECT_TRUE(has(message, "2 pairs of nodes are at the same position: 1 and 5, 3 and 6"));
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
  EXPECT_TRUE(has(message_of([&] { (void)mesh_of(dart); }), "tangled cells, whose Jacobian changes sign: element 1"));
  // A second-order triangle whose middle node lies beyond the opposite edge's.
  const std::string bent =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0.5 0.6 0\n5 0.5 0.5 0\n6 0 0.5 "
      "0\n$EndNodes\n"
      "$Elements\n1\n1 9 0 1 2 3 4 5 6\n$EndElements\n";
  EXPECT_TRUE(has(message_of([&] { (void)mesh_of(bent); }), "tangled cells"));
}

TEST(MalformedMesh, UnsupportedElementsOfGmshFilesAreCounted) {
  const auto message = [](const char* name) { return message_of([&] { (void)read_test_mesh(name); }); };
  EXPECT_TRUE(has(message("serendipity.msh"),
                  "4 elements of type 17 (20-node hexahedron); set Mesh.SecondOrderIncomplete = 0"));
  EXPECT_TRUE(has(message("third_order.msh"), "11 elements of type 21 (10-node triangle)"));
  EXPECT_TRUE(has(message("partitioned.msh"), "partitioned"));
}

TEST(MalformedMesh, HugeCountsInBinaryFilesAreRefusedBeforeAllocation) {
  std::string content = mesh_content("triangle_o1_msh41_binary.msh");
  const std::size_t place = content.find("$Nodes\n") + 7;
  const std::uint64_t huge = 1ull << 62;
  std::memcpy(content.data() + place + 8, &huge, sizeof huge);
  const std::string message = message_of([&] { (void)mesh_of(content); });
  EXPECT_TRUE(has(message, "the number of nodes is 4611686018427387904, which the remaining"));
  EXPECT_TRUE(has(message, "test.msh: byte "));
}

TEST(MalformedMesh, TheOtherByteOrderIsRefused) {
  std::string content = mesh_content("triangle_o1_msh41_binary.msh");
  const std::size_t place = content.find("8\n") + 2;
  std::reverse(content.begin() + std::ptrdiff_t(place), content.begin() + std::ptrdiff_t(place) + 4);
  EXPECT_TRUE(has(message_of([&] { (void)mesh_of(content); }), "opposite byte order"));
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
  constexpr std::size_t stride = is_sanitized ? 5 * parts : parts;
  for (auto place = std::size_t(part); place < content.size(); place += stride) {
    ++places;
    for (const int flip : {0x01, 0x04, 0x20, 0x80, 0xff}) {
      std::string damaged = content;
      damaged[place] = char(damaged[place] ^ flip);
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
}  // namespace ricochet::test_support
