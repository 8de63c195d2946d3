#include "ricochet/simulation/monitor/self_overlap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ricochet::self_overlap_test {

using Two = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;

/// Polygon of the corners, with each edge divided into `parts`.
std::vector<Two> refined(const std::vector<Two>& corners, int parts, bool closed = true) {
  std::vector<Two> result;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < corners.size(); ++i) {
    for (int k = 0; k < parts; ++k)
      result.emplace_back(corners[i] + double(k) / parts * (corners[(i + 1) % corners.size()] - corners[i]));
  }
  if (!closed) result.push_back(corners.back());
  return result;
}

Points as_points(const std::vector<Two>& outline) {
  Points result(2, Index(outline.size()));
  for (std::size_t i = 0; i < outline.size(); ++i) result.col(Index(i)) = outline[i];
  return result;
}

std::vector<BodySurface::Piece> segments(std::size_t count, bool closed = true) {
  std::vector<BodySurface::Piece> result;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < count; ++i) result.push_back({Index(i), Index((i + 1) % count), -1});
  return result;
}

/// Two arms of thickness 1 with a gap of 1 between them, from x = 1 to 4.
const std::vector<Two> clamp = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 2}, {4, 2}, {4, 3}, {0, 3}};

/// The upper arm moved down from x = 2 on, so far that it overlaps the lower one by `overlap`.
Two closed(const Two& point, double overlap) {
  if (point[1] < 1.5) return point;
  return {point[0], point[1] - (1.0 + overlap) * std::clamp(point[0] - 1.0, 0.0, 1.0)};
}

/// Nodes in the range of both arms, away from their ends.
bool is_between(const Two& reference) {
  return reference[0] >= 2.5 && reference[0] <= 3.5 && (reference[1] == 1.0 || reference[1] == 2.0);
}

TEST(SelfOverlap, IsThatOfTheArmsOfAClamp) {
  const std::vector<Two> reference = refined(clamp, 12);
  for (const double angle : {0.0, 0.7, 2.9}) {
    for (const double size : {1.0, 1e6, 1e-9}) {
      const Eigen::Rotation2Dd turn(angle);
      const auto outline = [&](double overlap) {
        std::vector<Two> result;
        for (const Two& point : reference) result.emplace_back(size * (turn * closed(point, overlap)));
        return result;
      };
      for (const double overlap : {-0.5, -1e-3, 0.0, 1e-6, 0.03, 0.4}) {
        const BodySurface surface(as_points(outline(overlap)), segments(reference.size()));
        const SelfOverlap test(surface, false);
        for (std::size_t i = 0; i < reference.size(); ++i) {
          const auto found = test.at(int(i));
          const double depth = found ? found->depth : 0.0;
          if (overlap <= 0.0) {
            EXPECT_LT(depth, 1e-14 * size) << overlap << ' ' << i;
          } else if (is_between(reference[i])) {
            ASSERT_TRUE(found) << overlap << ' ' << i;
            EXPECT_NEAR(depth, overlap * size, 1e-13 * size);
            // The two surfaces face each other.
            EXPECT_NEAR(surface.normal_of(found->own_piece).dot(surface.normal_of(found->other_piece)), -1.0, 1e-9);
          } else {
            EXPECT_LE(depth, overlap * size * (1.0 + 1e-9));
          }
        }
      }
    }
  }
}

/// A clamp of any thickness: its sides consist of triangles.
/// Nodes between the arms face the other arm; nodes outside of the clamp face nothing.
TEST(SelfOverlap, KnowsHowFarAwayWhatFacesANodeIs) {
  const std::vector<Two> reference = refined(clamp, 12);
  const BodySurface surface(as_points(reference), segments(reference.size()));
  const SelfOverlap test(surface, false);
  int between = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    double clearance = 0.0;
    EXPECT_FALSE(test.at(int(i), &clearance));
    const Two& at = reference[i];
    if (is_between(at)) {
      EXPECT_NEAR(clearance, 1.0, 1e-12);
      ++between;
    } else if (at[1] == 0.0 || at[1] == 3.0 || at[0] == 0.0) {
      EXPECT_TRUE(std::isinf(clearance)) << at.transpose();
    }
  }
  EXPECT_GT(between, 5);
}

TEST(SelfOverlap, IsTheSameInSpace) {
  const std::vector<Two> reference = refined(clamp, 6);
  const Index count = Index(reference.size());
  constexpr Index layers = 5;
  Points nodes(3, count * layers);
  std::vector<BodySurface::Piece> pieces;
  for (const double overlap : {-1e-3, 0.0, 0.2}) {
    pieces.clear();
    for (Index z = 0; z < layers; ++z) {
      for (Index i = 0; i < count; ++i) {
        const Two point = closed(reference[std::size_t(i)], overlap);
        nodes.col(z * count + i) = Vector3(point[0], point[1], 0.3 * double(z));
        const Index a = z * count + i, b = z * count + (i + 1) % count;
        if (z + 1 == layers) continue;
        pieces.push_back({a, b, b + count});
        pieces.push_back({a, b + count, a + count});
      }
    }
    const BodySurface surface(nodes, pieces);
    const SelfOverlap test(surface, false);
    for (Index z = 1; z + 1 < layers; ++z) {
      for (Index i = 0; i < count; ++i) {
        const auto found = test.at(int(z * count + i));
        if (overlap <= 0.0) {
          EXPECT_LT(found ? found->depth : 0.0, 1e-14);
        }
        if (overlap <= 0.0 || !is_between(reference[std::size_t(i)])) continue;
        ASSERT_TRUE(found) << i;
        EXPECT_NEAR(found->depth, overlap, 1e-13);
      }
    }
  }
}

/// Half of the section of a hollow ball: the pole of the hollow is pushed into the opposite wall, on the axis and
/// beside it, where rays meet the other half.
TEST(SelfOverlap, GoesOnBeyondAnAxis) {
  constexpr int parts = 24;
  for (const double overlap : {-0.1, 0.2}) {
    std::vector<Two> outline;
    std::vector<BodySurface::Piece> pieces;
    for (const double radius : {2.0, 1.0}) {
      const auto first = Index(outline.size());
      for (int k = 0; k <= parts; ++k) {
        const double angle = (radius > 1.5 ? 1.0 : -1.0) * std::numbers::pi * (double(k) / parts - 0.5);
        const bool on_axis = k == 0 || k == parts;
        Two point(on_axis ? 0.0 : radius * std::cos(angle), radius * std::sin(angle));
        if (point[1] > 0.0) point[1] -= (2.0 + overlap) * std::clamp(1.2 - 2.0 * point[0], 0.0, 1.0);
        outline.push_back(point);
        if (k > 0) pieces.push_back({first + k - 1, first + k, -1});
      }
    }
    const BodySurface surface(as_points(outline), pieces);
    const SelfOverlap test(surface, true);
    const int pole = parts + 1;  // pole of the hollow, at the top
    ASSERT_NEAR(outline[pole][1], -1.0 - overlap, 1e-14);
    const auto found = test.at(pole);
    ASSERT_EQ(found.has_value(), overlap > 0.0);
    if (found) {
      EXPECT_NEAR(found->depth, overlap, 1e-12);
    }
    ASSERT_EQ(test.at(2 * parts + 1).has_value(), overlap > 0.0) << "the pole that it went through";
  }
}

/// Tubes of long edges around narrow bores: rays across a bore meet the image's wall from outside, first that of the
/// node's own image.
TEST(SelfOverlap, IsNoneOfTubes) {
  for (const double bore : {0.02, 0.3, 2.0}) {
    for (const int parts : {1, 4, 16}) {
      const std::vector<Two> outline = refined({{bore, 0.0}, {bore + 1.0, 0.0}, {bore + 1.0, 0.8}, {bore, 0.8}}, parts);
      const BodySurface surface(as_points(outline), segments(outline.size()));
      const SelfOverlap test(surface, true);
      for (std::size_t i = 0; i < outline.size(); ++i)
        EXPECT_FALSE(test.at(int(i))) << bore << ' ' << parts << ' ' << i;
    }
  }
}

/// Bodies without folds have no overlap, whatever their corners.
TEST(SelfOverlap, IsNoneOfBodiesThatDoNotFold) {
  std::vector<Two> star, spiral;
  for (int k = 0; k < 14; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 14.0, radius = k % 2 == 0 ? 1.0 : 0.15;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  constexpr int turns = 90;
  const auto arm = [](double angle, double width) {
    return Two((0.2 + 0.1 * angle + width) * std::cos(angle), (0.2 + 0.1 * angle + width) * std::sin(angle));
  };
  for (int k = 0; k <= turns; ++k) spiral.push_back(arm(0.15 * k, 0.31));
  for (int k = turns; k >= 0; --k) spiral.push_back(arm(0.15 * k, 0.0));
  for (const std::vector<Two>& corners : {star, spiral, clamp}) {
    const std::vector<Two> outline = refined(corners, 3);
    const BodySurface surface(as_points(outline), segments(outline.size()));
    const SelfOverlap test(surface, false);
    for (std::size_t i = 0; i < outline.size(); ++i) EXPECT_FALSE(test.at(int(i))) << i;
  }
}

}  // namespace ricochet::self_overlap_test
