#include "ricochet/simulation/monitor/body_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

// Two squares of unit cells, one of which moves through the other as a rigid body: its position determines its depth.

namespace ricochet {
namespace {

std::vector<double> numbers_of(DeepestPoint point) {
  NumberVisitor visit;
  visit(point);
  return visit.written();
}

constexpr double edge = 0.1;

/// The square [0, 1]² and, 0.2 above its middle, a square with a side of 0.4.
struct TwoSquares {
  Points positions{2, 0};
  std::vector<CellBlock> cells{{CellShape::quadrilateral, 4, {}, {}}};
  ConnectedBodies bodies;
  std::vector<double> size;

  TwoSquares() {
    add(0.0, 0.0, 10);
    add(0.3, 1.2, 4);
  }

  void add(double x, double y, Index count) {
    const Index first = positions.cols(), row = count + 1;
    positions.conservativeResize(2, first + row * row);
    for (Index j = 0; j < row; ++j) {
      for (Index i = 0; i < row; ++i) {
        positions.col(first + j * row + i) << x + edge * double(i), y + edge * double(j);
        bodies.of_node.push_back(bodies.count);
        size.push_back(std::sqrt(2.0) * edge * double(count));
      }
    }
    for (Index j = 0; j < count; ++j) {
      for (Index i = 0; i < count; ++i) {
        const Index corner = first + j * row + i;
        for (const Index node : {corner, corner + 1, corner + row, corner + row + 1}) cells[0].nodes.push_back(node);
        cells[0].tags.push_back(0);
      }
    }
    ++bodies.count;
  }

  [[nodiscard]] BodyWatch watch(const std::vector<ContactNodeAllowance>& kept = {}) const {
    return {positions, cells, boundary_facets(cells), bodies, size, kept};
  }
  /// Nodes of the facing sides of the two squares, as contact nodes with these allowances.
  [[nodiscard]] std::vector<ContactNodeAllowance> facing_nodes(double of_lower, double of_upper) const {
    std::vector<ContactNodeAllowance> result;
    for (Index node = 0; node < positions.cols(); ++node) {
      const auto entry = Index(result.size());
      const double y = positions(1, node);
      const bool is_upper = bodies.of_node[std::size_t(node)] == 1;
      if (is_upper ? y < 1.25 : y > 0.95)
        result.push_back({node, is_upper ? 0 : 1, 7, entry, is_upper ? of_upper : of_lower});
    }
    return result;
  }
  /// Displacement of the second square.
  [[nodiscard]] Vector displacement(double x, double y) const {
    Vector result = Vector::Zero(2 * positions.cols());
    for (Index node = 0; node < positions.cols(); ++node) {
      if (bodies.of_node[std::size_t(node)] == 1) result.segment<2>(2 * node) << x, y;
    }
    return result;
  }
};

TEST(BodyWatch, FindsBodiesThatGoThroughEachOther) {
  const TwoSquares squares;
  BodyWatch watch = squares.watch();
  // Its lower side is at 1.2 − t. Its corner nodes are 0.3 from the sides: until then 1 − y is their depth.
  const double speed = 1.0, step = 1e-3;
  long steps = 0;
  for (; double(steps) * step < 0.35; ++steps) {
    watch.check(squares.displacement(0.0, -speed * double(steps) * step), double(steps) * step, false);
    const double depth = double(steps) * step - 0.2;
    if (depth < 0.0) {
      EXPECT_TRUE(watch.pairs().empty()) << depth;
    } else if (depth > 0.25 * edge) {
      // Detected no deeper than a quarter of an edge, and within an edge from then on.
      ASSERT_EQ(watch.pairs().size(), 1U) << depth;
      EXPECT_LE(watch.pairs()[0].deepest.depth, depth + 1e-12);
      EXPECT_GE(watch.pairs()[0].deepest.depth, depth - edge - speed * step);
    }
  }
  EXPECT_LT(watch.checks(), steps / 8);
  const double end = double(steps - 1) * step;
  watch.check(squares.displacement(0.0, -speed * end), end, true);
  ASSERT_EQ(watch.pairs().size(), 1U);
  const BodyPair& pair = watch.pairs()[0];
  EXPECT_EQ(pair.first, 0);
  EXPECT_EQ(pair.second, 1);
  EXPECT_NEAR(pair.deepest.depth, end - 0.2, 1e-14);
  EXPECT_EQ(pair.deepest.time, end);
  EXPECT_LT(pair.deepest.first_time, 0.2 + 0.25 * edge + 2.0 * step);
}

TEST(BodyWatch, SaysNothingOfBodiesThatPassOrTouch) {
  const TwoSquares squares;
  BodyWatch watch = squares.watch();
  // Down beside the other square, then along its side in contact, with coinciding nodes.
  for (int i = 0; i <= 200; ++i) watch.check(squares.displacement(0.8, -0.01 * i), i, false);
  for (int i = 0; i <= 200; ++i) watch.check(squares.displacement(0.7, -0.01 * i), i, true);
  EXPECT_TRUE(watch.pairs().empty());
  EXPECT_GT(watch.checks(), 5);
}

TEST(BodyWatch, SeesAnOverlapOfTheStart) {
  const TwoSquares squares;
  BodyWatch watch = squares.watch();
  watch.check(squares.displacement(0.0, -0.3), 0.0, false);
  ASSERT_EQ(watch.pairs().size(), 1U);
  EXPECT_NEAR(watch.pairs()[0].deepest.depth, 0.1, 1e-14);
}

/// Conditions between bodies hold in the mean over facets; a penetration beyond that allowance and beyond the gap of
/// the contact means that the pairing is wrong.
TEST(BodyWatch, LetsNodesOfAContactBeInsideByTheirAllowance) {
  const TwoSquares squares;
  Vector gap = Vector::Constant(100, std::nan(""));
  const auto gaps = [&]() -> const Vector& { return gap; };
  BodyWatch watch = squares.watch(squares.facing_nodes(0.05, 0.06));
  watch.check(squares.displacement(0.0, -0.2 - 0.049), 0.25, true, gaps);
  EXPECT_TRUE(watch.pairs().empty());
  watch.check(squares.displacement(0.0, -0.2 - 0.055), 0.5, true, gaps);
  ASSERT_EQ(watch.pairs().size(), 1U);
  EXPECT_FALSE(watch.pairs()[0].deepest.found());
  EXPECT_EQ(watch.pairs()[0].contact, 7);
  EXPECT_NEAR(watch.pairs()[0].at_contact.depth, 0.055, 1e-12);
  EXPECT_NEAR(watch.pairs()[0].at_contact.position[1], 1.0, 1e-12) << "a node of the lower one";
  // Penetration that the contact itself detects is not reported.
  gap.setConstant(-0.04);
  BodyWatch knowing = squares.watch(squares.facing_nodes(0.05, 0.05));
  knowing.check(squares.displacement(0.0, -0.2 - 0.089), 0.25, true, gaps);
  EXPECT_TRUE(knowing.pairs().empty());
  knowing.check(squares.displacement(0.0, -0.2 - 0.091), 0.5, true, gaps);
  ASSERT_EQ(knowing.pairs().size(), 1U);
  EXPECT_NEAR(knowing.pairs()[0].at_contact.depth, 0.091, 1e-12);
  // All other nodes are checked as before: here the second row of the upper square.
  EXPECT_FALSE(knowing.pairs()[0].deepest.found());
  gap.setConstant(-1.0);
  knowing.check(squares.displacement(0.0, -0.2 - 0.11), 0.75, true, gaps);
  EXPECT_NEAR(knowing.pairs()[0].deepest.depth, 0.01, 1e-12);
  EXPECT_NEAR(knowing.pairs()[0].at_contact.depth, 0.091, 1e-12);
  // A resumed run keeps both.
  Snapshot snapshot;
  knowing.persist(snapshot.saver("bodies"));
  BodyWatch resumed = squares.watch(squares.facing_nodes(0.05, 0.05));
  resumed.persist(snapshot.loader("bodies"));
  ASSERT_EQ(resumed.pairs().size(), 1U);
  EXPECT_EQ(resumed.pairs()[0].contact, 7);
  EXPECT_EQ(numbers_of(resumed.pairs()[0].at_contact), numbers_of(knowing.pairs()[0].at_contact));
  EXPECT_EQ(numbers_of(resumed.pairs()[0].deepest), numbers_of(knowing.pairs()[0].deepest));
}

TEST(BodyWatch, GoesOnWhereItWasSaved) {
  const TwoSquares squares;
  BodyWatch whole = squares.watch();
  std::unique_ptr<BodyWatch> parts = std::make_unique<BodyWatch>(squares.watch());
  for (int i = 0; i <= 300; ++i) {
    const Vector now = squares.displacement(0.0, -0.002 * i);
    whole.check(now, i, i == 300);
    parts->check(now, i, i == 300);
    if (i % 37 != 0) continue;
    Snapshot snapshot;
    parts->persist(snapshot.saver("watch"));
    parts = std::make_unique<BodyWatch>(squares.watch());
    parts->persist(snapshot.loader("watch"));
  }
  EXPECT_EQ(parts->checks(), whole.checks());
  ASSERT_EQ(parts->pairs().size(), 1U);
  EXPECT_EQ(numbers_of(parts->pairs()[0].deepest), numbers_of(whole.pairs()[0].deepest));
}

}  // namespace
}  // namespace ricochet
