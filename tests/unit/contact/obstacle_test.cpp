#include "ricochet/contact/obstacle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "ricochet/base/error.hpp"

/// @file What every obstacle promises of its gap, normal and motion.
namespace ricochet {
namespace {

/// Every registered type, placed askew and moving, in both dimensions.
std::unique_ptr<Obstacle> placed(const std::string& type, Index dimension, const std::string& side = "outside") {
  const auto cut = [&](std::vector<double> values) {
    values.resize(static_cast<std::size_t>(dimension));
    return values;
  };
  Parameters parameters{{"velocity", cut({0.3, -0.2, 0.5})}};
  if (type == "plane") {
    parameters.set("point", cut({0.1, -0.4, 0.2}));
    parameters.set("normal", cut({1.0, 2.0, -0.5}));
    if (dimension == 3) parameters.set("rotation_rate", 0.7);
  } else if (type == "sphere") {
    parameters.set("centre", cut({0.1, -0.4, 0.2}));
    parameters.set("radius", 0.8);
    parameters.set("side", side);
  } else {
    ADD_FAILURE() << "place the obstacle \"" << type << "\" here, so that it is tested";
  }
  return make_obstacle(type, parameters);
}

class Obstacles : public testing::TestWithParam<std::tuple<std::string, Index, std::string>> {
 protected:
  [[nodiscard]] Index dimension() const { return std::get<1>(GetParam()); }
  [[nodiscard]] std::unique_ptr<Obstacle> make() const {
    return placed(std::get<0>(GetParam()), dimension(), std::get<2>(GetParam()));
  }
  [[nodiscard]] Vector random_point() {
    Vector point(dimension());
    for (double& x : point) x = 4.0 * static_cast<double>(random_()) / 4294967296.0 - 2.0;
    return point;
  }
  std::mt19937 random_{3};
};

TEST_P(Obstacles, HaveUnitNormalsThatAreTheDerivativeOfTheGap) {
  const auto obstacle = make();
  for (int k = 0; k < 50; ++k) {
    const Vector point = random_point();
    const SpaceVector normal = obstacle->normal(point);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-15);
    constexpr double h = 1e-6;
    for (Index i = 0; i < dimension(); ++i) {
      const Vector step = h * Vector::Unit(dimension(), i);
      const double slope = (obstacle->gap(point + step) - obstacle->gap(point - step)) / (2.0 * h);
      EXPECT_NEAR(normal[i], slope, 1e-8);
    }
  }
}

/// Along the normal of a step it goes out where the gap grows, in where it shrinks, and neither where it stays.
TEST_P(Obstacles, HaveNormalsOfStepsThatKnowTheChangeOfTheGap) {
  const auto obstacle = make();
  int near = 0;
  for (int k = 0; k < 200; ++k) {
    const Vector from = random_point();
    Vector to = from + 0.3 * random_point();
    SpaceVector normal = obstacle->normal_of_step(from, to);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-15);
    EXPECT_GE(normal.dot(obstacle->normal(to)), 0.5);
    if (normal == obstacle->normal(to) && !obstacle->is_flat()) continue;  // too far round
    ++near;
    const double change = obstacle->gap(to) - obstacle->gap(from);
    EXPECT_GE(normal.dot(to - from) * change, -1e-15);
    EXPECT_GE(std::abs(normal.dot(to - from)), std::abs(change) - 2e-15);  // a ≥ 1 on planes and spheres
    EXPECT_EQ(obstacle->normal_of_step(to, to), obstacle->normal(to));
    to += (obstacle->gap(from) - obstacle->gap(to)) * obstacle->normal(to);
    normal = obstacle->normal_of_step(from, to);
    if (normal != obstacle->normal(to)) {
      EXPECT_NEAR(normal.dot(to - from), 0.0, 2e-15);
    }
  }
  EXPECT_GT(near, 50);
}

/// The gap is a distance: along the normal it changes by as much as one goes, until the surface and beyond.
TEST_P(Obstacles, HaveGapsThatAreDistances) {
  const auto obstacle = make();
  for (int k = 0; k < 50; ++k) {
    const Vector point = random_point();
    const double gap = obstacle->gap(point);
    const Vector foot = point - gap * obstacle->normal(point);
    EXPECT_NEAR(obstacle->gap(foot), 0.0, 1e-14);
    EXPECT_GT(obstacle->gap_rounding(point), 0.0);
    EXPECT_LT(obstacle->gap_rounding(point), 1e-13);
    if (obstacle->is_flat())
      EXPECT_NEAR(obstacle->gap(0.5 * (point + foot)), 0.5 * gap, 1e-14);
    else
      EXPECT_NE(obstacle->normal(point), obstacle->normal(random_point()));
  }
}

/// Surfaces for pictures lie on the obstacle, also after it has moved.
TEST_P(Obstacles, HaveSurfacesWhereTheyAre) {
  const auto obstacle = make();
  constexpr double time = 0.5;
  const SpaceVector moved = obstacle->translation(time);
  EXPECT_TRUE(obstacle->moves());
  EXPECT_GT(moved.norm(), 0.1);
  const Points start = obstacle->surface(random_point(), 0.3).points;
  const Points later = obstacle->surface_points(start, time);
  ASSERT_GT(start.cols(), 1);
  ASSERT_EQ(later.cols(), start.cols());
  EXPECT_LT((obstacle->surface_points(start, 0.0) - start).cwiseAbs().maxCoeff(), 1e-14);
  for (Index k = 0; k < start.cols(); ++k) {
    EXPECT_NEAR(obstacle->gap(SpaceVector(start.col(k))), 0.0, 1e-14);
    EXPECT_NEAR(obstacle->gap(SpaceVector(later.col(k)) - moved), 0.0, 1e-14);
    // The picture keeps its size.
    EXPECT_NEAR((later.col(k) - later.col(0)).norm(), (start.col(k) - start.col(0)).norm(), 1e-14);
  }
  // What the material does, the surface does along its normal.
  const Vector foot = later.col(0);
  const Vector normal = obstacle->normal(foot - moved);
  EXPECT_NEAR(obstacle->surface_velocity(foot, time).dot(normal), moved.dot(normal) / time, 1e-14);
  const Vector way = later.col(0) - start.col(0);
  EXPECT_NEAR(way.dot(normal), moved.dot(normal), 1e-14);
}

/// The cells' sides tell where the obstacle is, and what they share is there once.
TEST_P(Obstacles, HaveSurfacesThatFaceOut) {
  const auto obstacle = make();
  // A part, and all that there is.
  for (const double radius : {0.1, 3.0}) {
    const ObstacleSurface surface = obstacle->surface(random_point(), radius);
    const auto corners = static_cast<std::size_t>(surface.corners());
    ASSERT_EQ(corners, dimension() == 2 ? 2U : 4U);
    ASSERT_EQ(surface.cells.size() % corners, 0U);
    std::vector<int> uses(static_cast<std::size_t>(surface.points.cols()), 0);
    for (std::size_t c = 0; c < surface.cells.size(); c += corners) {
      std::vector<Vector> at;
      for (std::size_t k = c; k < c + corners; ++k) {
        ASSERT_GE(surface.cells[k], 0);
        ASSERT_LT(surface.cells[k], surface.points.cols());
        ++uses[static_cast<std::size_t>(surface.cells[k])];
        at.emplace_back(surface.points.col(surface.cells[k]));
      }
      if (dimension() == 2) {
        const Vector along = at[1] - at[0], middle = 0.5 * (at[0] + at[1]);
        const Eigen::Vector2d left(-along[1], along[0]);
        EXPECT_NEAR(left.dot(Eigen::Vector2d(obstacle->normal(middle))), along.norm(), 1e-12);
        EXPECT_EQ(surface.cells[c], c > 0 ? surface.cells[c - 1] : 0);
      } else {
        const Eigen::Vector3d one = at[2] - at[0], other = at[3] - at[1], area = one.cross(other);
        const Vector middle = 0.25 * (at[0] + at[1] + at[2] + at[3]);
        EXPECT_GT(area.dot(Eigen::Vector3d(obstacle->normal(middle))), 0.99 * area.norm());
        EXPECT_GT(area.norm(), 0.0);
      }
    }
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0);
    // One more than cells at a pole or an end, not four for each cell.
    const auto cells = static_cast<Index>(surface.cells.size() / corners);
    EXPECT_LE(surface.points.cols(), obstacle->is_flat() ? 4 : cells + 1);
    for (Index i = 0; i < surface.points.cols(); ++i) {
      for (Index k = 0; k < i && dimension() == 3; ++k)
        ASSERT_GT((surface.points.col(i) - surface.points.col(k)).lpNorm<1>(), 1e-9) << i << " is " << k << " again";
    }
  }
}

/// Planes are shown beside the body when they move along themselves, and turn; spheres go with what moves them.
TEST(Obstacle, IsShownWhereItCanBeSeen) {
  const auto plane = placed("plane", 3);
  const ObstacleSurface square = plane->surface(Vector::Zero(3), 0.3);
  const Points later = plane->surface_points(square.points, 0.5);
  const Vector start_middle = square.points.rowwise().mean(), middle = later.rowwise().mean();
  const Vector normal = plane->normal(middle);
  EXPECT_NEAR((middle - start_middle).norm(), std::abs(plane->translation(0.5).dot(normal)), 1e-15);
  const Vector before = square.points.col(0) - start_middle, after = later.col(0) - middle;
  EXPECT_NEAR(before.dot(after), std::cos(0.7 * 0.5) * before.squaredNorm(), 1e-15);

  const auto sphere = placed("sphere", 3);
  const ObstacleSurface cap = sphere->surface(Vector::Zero(3), 0.3);
  const Points moved = sphere->surface_points(cap.points, 0.5);
  EXPECT_LT(((moved - cap.points).colwise() - Vector(sphere->translation(0.5))).cwiseAbs().maxCoeff(), 1e-15);
}

INSTANTIATE_TEST_SUITE_P(All, Obstacles, testing::ValuesIn([] {
                           std::vector<std::tuple<std::string, Index, std::string>> all;
                           for (const std::string& type : obstacle_registry().names()) {
                             for (const Index dimension : {2, 3}) all.emplace_back(type, dimension, "outside");
                           }
                           for (const Index dimension : {2, 3}) all.emplace_back("sphere", dimension, "inside");
                           return all;
                         }()),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" + std::get<2>(info.param) + "_" +
                                  std::to_string(std::get<1>(info.param)) + "d";
                         });

TEST(Obstacle, IsRefusedWithoutItsValuesOrWithOthers) {
  const auto message = [](const std::string& type, const Parameters& parameters) {
    try {
      (void)make_obstacle(type, parameters);
    } catch (const Error& problem) {
      return std::string(problem.what());
    }
    return std::string("none");
  };
  using Numbers = std::vector<double>;
  EXPECT_EQ(message("cone", {}), "unknown obstacle type \"cone\"; known: \"plane\" and \"sphere\"");
  EXPECT_EQ(message("sphere", {{"centre", Numbers{0.0, 0.0}}}),
            "obstacle type \"sphere\" needs the parameter \"radius\"");
  EXPECT_NE(message("plane", {{"centre", Numbers{0.0, 0.0}}}).find("has no parameter \"centre\""), std::string::npos);
  EXPECT_EQ(message("sphere", {{"centre", 1.0}, {"radius", 1.0}}),
            "obstacle type \"sphere\": the parameter \"centre\" is 1; it must be a vector of 2 or 3 numbers");
  EXPECT_EQ(message("sphere", {{"centre", Numbers{0.0, 0.0}}, {"radius", -1.0}}),
            "obstacle type \"sphere\": the parameter \"radius\" is -1; it must be a positive number");
  EXPECT_EQ(message("plane", {{"point", Numbers{0.0, 0.0}}, {"normal", Numbers{0.0, 0.0}}}),
            "the normal of a plane is zero");
}

}  // namespace
}  // namespace ricochet
