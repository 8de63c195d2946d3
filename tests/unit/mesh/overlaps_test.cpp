#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "ricochet/base/log.hpp"
#include "ricochet/mesh/check_overlaps.hpp"
#include "support.hpp"
#include "support/box_mesh.hpp"

/// @file Cells that overlap although no Jacobian is negative.
namespace ricochet::test_support {
namespace {

/// Triangles of a quarter turn each around node 1 at (3, 4), closing after `turns`; in space each with a tetrahedron
/// above and below. Radii differ, so that no nodes coincide.
std::string fan(int turns, bool in_space) {
  const int count = 4 * turns;
  std::string nodes = "1 3 4 0\n", cells;
  int number = 0;
  for (int k = 0; k < count; ++k) {
    const double angle = 0.5 * std::numbers::pi * k, radius = 1.0 + 0.1 * k;
    nodes +=
        fmt::format("{} {:.17g} {:.17g} 0\n", k + 2, 3.0 + radius * std::cos(angle), 4.0 + radius * std::sin(angle));
    const int one = k + 2, other = (k + 1) % count + 2;
    if (in_space) {
      cells += fmt::format("{} 4 2 1 1 1 {} {} {}\n", ++number, one, other, count + 2);
      cells += fmt::format("{} 4 2 1 1 1 {} {} {}\n", ++number, other, one, count + 3);
    } else {
      cells += fmt::format("{} 2 2 1 1 1 {} {}\n", ++number, one, other);
    }
  }
  if (in_space) nodes += fmt::format("{} 3 4 1\n{} 3 4 -1\n", count + 2, count + 3);
  return fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
                     count + (in_space ? 3 : 1), nodes, number, cells);
}

std::string warnings_of(const std::string& content) {
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  static_cast<void>(mesh_of(content));
  std::string text;
  for (const std::string& warning : warnings) text += warning + "\n";
  return text;
}

TEST(Overlaps, AroundANodeAreWarnedOf) {
  for (const bool in_space : {false, true}) {
    EXPECT_EQ(warnings_of(fan(1, in_space)), "");
    const std::string twice = warnings_of(fan(2, in_space));
    EXPECT_TRUE(has(twice, fmt::format("around node 1 at (3, 4{}) they fill 2 times the full", in_space ? ", 0" : "")));
    EXPECT_TRUE(has(warnings_of(fan(3, in_space)), "fill 3 times"));
  }
}

/// Angles around interior nodes add up exactly, also for distorted and curved cells.
TEST(Overlaps, AreNotSeenWhereThereAreNone) {
  for (const CellShape shape : all_cell_shapes()) {
    for (const int degree : {1, 2}) {
      BoxMesh box;
      box.shape = shape;
      box.counts.assign(std::size_t(dimension(shape)), 4);
      box.geometry_degree = degree;
      box.map = swirl_map(0.05);
      const Mesh mesh = make_checked_box_mesh(box);
      std::vector<std::string> warnings;
      const log::CollectWarnings collect(warnings);
      gmsh::warn_of_overlaps(mesh);
      EXPECT_TRUE(warnings.empty()) << warnings.front();
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
