#include "ricochet/simulation/monitor/stress_raisers.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>

#include "ricochet/fem/stress.hpp"
#include "support/case_run.hpp"
#include "support/two_bodies.hpp"

/// @file Location of the largest stress: corners, supports, contact, and similar positions with finite stress.
namespace ricochet::test_support::stress_raisers_test {

std::string static_case(const std::string& mesh, const std::string& more, const std::string& body = "body") {
  return fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = 1\n[[material]]\ngroup = \"{}\"\ndensity = 1.0\nyoung = "
      "100.0\npoisson = 0.3\n{}[initial]\ndisplacement = \"static\"\n[mass]\ntype = \"consistent\"\n[time]\n"
      "scheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 1e-3\nend = 1e-3\n",
      mesh, body, more);
}

std::string hold(const std::string& group, const std::string& components, double value = 0.0) {
  return fmt::format("[[support]]\ngroup = \"{}\"\ncomponents = [{}]\nvalue = {}\n", group, components, value);
}

std::string pull(const std::string& group, const std::string& traction) {
  return fmt::format("[[traction]]\ngroup = \"{}\"\nvalue = [{}]\n", group, traction);
}

class Raisers {
 public:
  explicit Raisers(const CaseRun& run)
      : run_(run), raisers_(run.model().body, run.problem(), run.model().contact_pairs, run.model().bodies) {}

  [[nodiscard]] std::string at(Index cell) { return name_of(raisers_.at(run_.state(), cell)); }
  /// Description of the cell with the largest stress.
  [[nodiscard]] std::string at_peak() {
    return at(CellStress(run_.model().body).largest_von_mises(run_.state().displacement).cell);
  }
  [[nodiscard]] Index count() {
    Index result = 0;
    for (Index cell = 0; cell < run_.model().mesh.cell_count(); ++cell) result += at(cell).empty() ? 0 : 1;
    return result;
  }

 private:
  const CaseRun& run_;
  StressRaisers raisers_;
};

std::string box_mesh(const std::string& name, CellShape shape, int count, const PointMap& map = {}) {
  BoxMesh box = box_of(shape, std::vector<int>(std::size_t(dimension(shape)), count));
  box.distortion = 0.0;
  box.map = map;
  return write_mesh(name, make_box_mesh(box));
}

TEST(StressRaisers, ClampedBeam) {
  for (const CellShape shape : all_cell_shapes()) {
    const bool flat = dimension(shape) == 2;
    const CaseRun run(static_case(box_mesh("clamped-" + name(shape) + ".msh", shape, 4),
                                  hold("x0", flat ? R"("x", "y")" : R"("x", "y", "z")") +
                                      pull("x1", flat ? R"("0", "-0.1")" : R"("0", "0", "-0.1")")));
    EXPECT_EQ(Raisers(run).at_peak(), "the edge of a support") << name(shape);
  }
}

/// Supports along the normal alone are mirrors: the box continues beyond them, and its free corners are unloaded.
TEST(StressRaisers, PlanesOfSymmetryAreNone) {
  for (const CellShape shape : all_cell_shapes()) {
    const bool flat = dimension(shape) == 2;
    const CaseRun run(static_case(box_mesh("symmetric-" + name(shape) + ".msh", shape, 3),
                                  hold("x0", R"("x")") + hold("y0", R"("y")") + (flat ? "" : hold("z0", R"("z")")) +
                                      pull("x1", flat ? R"("1", "0")" : R"("1", "0", "0")")));
    EXPECT_EQ(Raisers(run).count(), 0) << name(shape);
  }
}

/// A plane of symmetry that ends on a flat side is the root of a crack.
TEST(StressRaisers, Crack) {
  const PointMap wide = [](const Vector& x) -> Vector { return Eigen::Vector2d(2.0 * x[0] - 1.0, x[1]); };
  BoxMesh box = box_of(CellShape::quadrilateral, {8, 6});
  box.distortion = 0.0;
  box.map = wide;
  Mesh mesh = make_box_mesh(box);
  Group& bottom =
      *std::ranges::find_if(mesh.groups, [](const Group& group) { return group.name == "y0" && group.dimension == 1; });
  std::erase_if(bottom.members, [&](Index facet) {
    const IndexInBlocks place = locate_in_blocks(mesh.facets, facet);
    const Index* const nodes = mesh.facets[place.block].cell(place.local);
    return mesh.nodes(0, nodes[0]) + mesh.nodes(0, nodes[1]) < 0.0;
  });
  const CaseRun run(static_case(write_mesh("crack.msh", mesh),
                                hold("y0", R"("y")") + hold("x1", R"("x")") + pull("y1", R"("0", "1")")));
  EXPECT_EQ(Raisers(run).at_peak(), "the edge of a support");
}

/// Facets of 15° and of 30° represent a circular hole: its largest stress, on a plane of symmetry, is finite.
TEST(StressRaisers, FacetsOfAHoleAreNone) {
  for (const int count : {3, 6}) {
    const PointMap quarter = [](const Vector& x) -> Vector {
      const double angle = 0.5 * std::numbers::pi * x[1], radius = 1.0 + 3.0 * x[0];
      return Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle));
    };
    const CaseRun run(static_case(box_mesh(fmt::format("hole-{}.msh", count), CellShape::quadrilateral, count, quarter),
                                  hold("y0", R"("y")") + hold("y1", R"("x")") + pull("x1", R"("x", "0")")));
    EXPECT_EQ(Raisers(run).count(), 0);
  }
}

/// A hole with four corners, as of a square, makes the body re-entrant there.
TEST(StressRaisers, CornersOfASquareHole) {
  const PointMap quarter = [](const Vector& x) -> Vector {
    const double angle = 0.5 * std::numbers::pi * x[1];
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    return (1.0 / direction.maxCoeff() + 3.0 * x[0]) * direction;
  };
  const CaseRun run(static_case(box_mesh("square-hole.msh", CellShape::quadrilateral, 8, quarter),
                                hold("y0", R"("y")") + hold("y1", R"("x")") + pull("x1", R"("x", "0")")));
  EXPECT_EQ(Raisers(run).at_peak(), "a re-entrant edge of the body");
}

std::string on_floor(const std::string& group, const std::string& obstacle, const std::string& friction) {
  return fmt::format("[obstacle.floor]\n{}[[contact]]\ngroup = \"{}\"\nobstacle = \"floor\"\n{}", obstacle, group,
                     friction);
}

/// Without friction the plane is a mirror, too, as long as the face lies on it.
TEST(StressRaisers, ABlockOnAPlane) {
  const std::string mesh = box_mesh("on-plane.msh", CellShape::quadrilateral, 4);
  const std::string plane = "type = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n",
                    top = hold("y1", R"("y")", -0.05);
  const CaseRun smooth(static_case(mesh, on_floor("y0", plane, "") + top + hold("x0", R"("x")")));
  EXPECT_EQ(Raisers(smooth).count(), 0);
  const CaseRun rough(static_case(mesh, on_floor("y0", plane, "friction = 0.5\n") + top));
  Raisers raisers(rough);
  each_cell(rough.model().mesh.cells, [&](Index cell, std::span<const Index>) {
    const Vector centre = location_of_cell(rough.model().mesh, cell).centre;
    const bool is_corner = centre[1] < 0.25 && std::abs(centre[0] - 0.5) > 0.25;
    if (!is_corner && centre[1] < 0.5) return;
    EXPECT_EQ(raisers.at(cell), is_corner ? "a sharp edge in contact" : "");
  });
}

/// If the cell in the corner is stiff, the next one has the larger mean and approaches the corner with each refinement.
TEST(StressRaisers, ReachTheNextCell) {
  const CaseRun run(static_case(box_mesh("next-cell.msh", CellShape::triangle, 8),
                                hold("x0", R"("x", "y")") + pull("x1", R"("0", "-0.1")")));
  Raisers raisers(run);
  each_cell(run.model().mesh.cells, [&](Index cell, std::span<const Index>) {
    const Vector centre = location_of_cell(run.model().mesh, cell).centre;
    const bool is_next = centre[0] < 0.25 && centre[1] > 0.875;
    if (!is_next && centre[0] < 0.25) return;
    EXPECT_EQ(raisers.at(cell), is_next ? "the edge of a support" : "") << centre.transpose();
  });
}

TEST(StressRaisers, ARoundObstacle) {
  const PointMap centred = [](const Vector& x) -> Vector { return Eigen::Vector2d(2.0 * x[0] - 1.0, x[1]); };
  const std::string mesh = box_mesh("on-round.msh", CellShape::quadrilateral, 8, centred);
  for (const double radius : {0.1, 20.0}) {
    const std::string ball =
        fmt::format("type = \"sphere\"\ncentre = [0.0, {}]\nradius = {}\n", 0.004 - radius, radius);
    const CaseRun run(static_case(mesh, on_floor("y0", ball, "") + hold("y1", R"("y")") + hold("x0", R"("x")")));
    Raisers raisers(run);
    EXPECT_EQ(raisers.at_peak(), radius < 1.0 ? "contact with a sharp edge of an obstacle" : "") << radius;
  }
}

/// Equal blocks that lie on each other form one block; a narrow one is a punch.
TEST(StressRaisers, BlocksOnEachOther) {
  for (const bool is_punch : {false, true}) {
    StackedBoxes stack{CellShape::quadrilateral, CellShape::quadrilateral, {8, 8}, {4, 4}};
    stack.distortion = 0.0;
    if (is_punch)
      stack.upper_map = [](const Vector& x) -> Vector { return Eigen::Vector2d(0.3 + 0.4 * x[0], 1.0 + x[1]); };
    const CaseRun run(static_case(write_mesh(fmt::format("blocks-{}.msh", is_punch), make_stack(stack)),
                                  "[[contact]]\ngroup = "
                                  "\"upper.y0\"\nagainst = \"lower.y1\"\n" +
                                      hold("lower.y0", R"("y")") + hold("upper.y1", R"("y")", -0.02) +
                                      hold("lower.x0", R"("x")") +
                                      (is_punch ? hold("upper.y1", R"("x")") : hold("upper.x0", R"("x")")),
                                  "all"));
    Raisers raisers(run);
    if (is_punch) {
      EXPECT_EQ(raisers.at_peak(), "a sharp edge in contact");
    } else {
      EXPECT_EQ(raisers.count(), 0);
    }
  }
}

}  // namespace ricochet::test_support::stress_raisers_test
