#include "ricochet/rigid/obstacle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "ricochet/base/error.hpp"
#include "support/errors.hpp"

/// @file Properties of the gap, the normal and the motion of every obstacle.
namespace ricochet::test_support {
namespace {

using Numbers = std::vector<double>;

/// Returns a skew obstacle of any registered type except surfaces from files (see rigid_surface_test.cpp).
std::unique_ptr<ObstacleShape> shape_of(const std::string& type, Index dimension, const std::string& side) {
  const auto cut = [&](Numbers values) {
    values.resize(std::size_t(dimension));
    return values;
  };
  Parameters parameters;
  if (type != "plane") parameters.set("side", side);
  if (type == "plane") {
    parameters.set("point", cut({0.1, -0.4, 0.2}));
    parameters.set("normal", cut({1.0, 2.0, -0.5}));
  } else if (type == "implicit") {
    parameters.set("expression", dimension == 2 ? std::string("(x - 0.1)^2 + 2*(y + 0.4)^2 - 0.6")
                                                : std::string("(x - 0.1)^2 + 2*(y + 0.4)^2 + z^2 + 0.3*x*z - 0.6"));
  } else {
    parameters.set("centre", cut({0.1, -0.4, 0.2}));
    if (type == "torus") {
      parameters.set("ring_radius", 0.9);
      parameters.set("tube_radius", 0.4);
    } else {
      parameters.set("radius", 0.8);
    }
    if (type != "sphere") parameters.set("axis", Numbers{1.0, 2.0, -0.5});
  }
  return make_obstacle_shape(type, parameters);
}

/// Returns a moving obstacle with the shape of the type; turntables also turn in their plane.
std::unique_ptr<Obstacle> placed(const std::string& type, Index dimension, const std::string& side = "outside") {
  const Vector velocity = Eigen::Vector3d(0.3, -0.2, 0.5).head(dimension);
  std::unique_ptr<ObstacleShape> shape = shape_of(type, dimension, side);
  const double spin = shape->symmetry_axis().exists ? 0.7 : 0.0;
  return std::make_unique<Obstacle>(std::move(shape), make_uniform_path(velocity), spin, Vector::Zero(dimension));
}

/// Accuracy of the gaps and normals of a type.
double rounding_of(const std::string& type) { return type == "implicit" ? 1e-11 : 1e-14; }

class Obstacles : public testing::TestWithParam<std::tuple<std::string, Index, std::string>> {
 protected:
  [[nodiscard]] Index dimension() const { return std::get<1>(GetParam()); }
  [[nodiscard]] std::unique_ptr<Obstacle> make() const { return placed(type(), dimension(), std::get<2>(GetParam())); }
  [[nodiscard]] const std::string& type() const { return std::get<0>(GetParam()); }
  [[nodiscard]] double rounding() const { return rounding_of(type()); }
  [[nodiscard]] Vector random_point() {
    Vector point(dimension());
    for (double& x : point) x = 4.0 * double(random_()) / 4294967296.0 - 2.0;
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
      EXPECT_NEAR(normal[i], slope, type() == "implicit" ? 1e-7 : 2e-8);
    }
  }
}

/// The displacement along the normal of a step is positive if the gap grows, negative if it shrinks, and zero if it
/// does not change.
TEST_P(Obstacles, HaveNormalsOfStepsThatKnowTheChangeOfTheGap) {
  const auto obstacle = make();
  int near = 0;
  for (int k = 0; k < 200; ++k) {
    const Vector from = random_point();
    Vector to = from + 0.3 * random_point();
    SpaceVector normal = obstacle->shape().normal_of_step(from, to);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-15);
    EXPECT_GE(normal.dot(obstacle->normal(to)), 0.0);
    // For every step: no force along its normal creates energy.
    EXPECT_GE(normal.dot(to - from) * (obstacle->gap(to) - obstacle->gap(from)), -rounding());
    if (normal.dot(obstacle->normal(to)) < 0.5) continue;                          // far round the obstacle
    if (normal == obstacle->normal(to) && !obstacle->shape().is_flat()) continue;  // far round the obstacle
    if (std::abs(normal.dot(to - from)) < rounding()) continue;                    // far round, on the opposite side
    ++near;
    const double change = obstacle->gap(to) - obstacle->gap(from);
    EXPECT_GE(normal.dot(to - from) * change, -rounding());
    // The default corrects the normal, so that the force has a component along the surface.
    const bool is_corrected = normal == obstacle->shape().ObstacleShape::normal_of_step(from, to);
    EXPECT_FALSE(is_corrected && (type() == "sphere" || type() == "cylinder"));
    const double factor = is_corrected && !obstacle->shape().is_flat() ? 0.2 : 1.0;
    EXPECT_GE(std::abs(normal.dot(to - from)), factor * std::abs(change) - rounding());
    EXPECT_LT((obstacle->shape().normal_of_step(to, to) - obstacle->normal(to)).norm(), 1e-15);
    to += (obstacle->gap(from) - obstacle->gap(to)) * obstacle->normal(to);
    normal = obstacle->shape().normal_of_step(from, to);
    if (normal != obstacle->normal(to)) {
      EXPECT_NEAR(normal.dot(to - from), 0.0, 2.0 * rounding());
    }
  }
  EXPECT_GT(near, 50);
}

/// The gap is a distance: along the normal it changes by the length of the path, up to the surface and beyond.
TEST_P(Obstacles, HaveGapsThatAreDistances) {
  const auto obstacle = make();
  for (int k = 0; k < 50; ++k) {
    const Vector point = random_point();
    const double gap = obstacle->gap(point);
    const Vector foot = point - gap * obstacle->normal(point);
    EXPECT_NEAR(obstacle->gap(foot), 0.0, rounding());
    EXPECT_GT(obstacle->gap_rounding(point), 0.0);
    EXPECT_LT(obstacle->gap_rounding(point), 1e-13);
    if (obstacle->shape().is_flat())
      EXPECT_NEAR(obstacle->gap(0.5 * (point + foot)), 0.5 * gap, 1e-14);
    else
      EXPECT_NE(obstacle->normal(point), obstacle->normal(random_point()));
  }
}

/// Surfaces for visualization lie on the obstacle, also after it has moved.
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
    const double coarse = type() == "implicit" ? 0.01 : 1e-14;  // cuts of a grid
    EXPECT_NEAR(obstacle->gap(SpaceVector(start.col(k))), 0.0, coarse);
    EXPECT_NEAR(obstacle->at(time).gap(SpaceVector(later.col(k))), 0.0, coarse);
    // The surface keeps its size.
    EXPECT_NEAR((later.col(k) - later.col(0)).norm(), (start.col(k) - start.col(0)).norm(), 1e-14);
  }
  // The normal velocity of the surface is that of the material.
  const Vector foot = later.col(0);
  const Vector normal = obstacle->at(time).normal(foot);
  EXPECT_NEAR(obstacle->surface_velocity(foot, time).dot(normal), moved.dot(normal) / time, 1e-12);
  const Vector way = later.col(0) - start.col(0);
  EXPECT_NEAR(way.dot(normal), moved.dot(normal), 1e-14);
}

/// The orientation of the cells shows the side of the obstacle, and shared nodes occur once.
TEST_P(Obstacles, HaveSurfacesThatFaceOut) {
  const auto obstacle = make();
  // A part of the obstacle, and all of it.
  for (const double radius : {0.1, 3.0}) {
    bool has_poles = false;
    const ObstacleSurface surface = obstacle->surface(random_point(), radius);
    const auto corners = std::size_t(surface.corners());
    ASSERT_EQ(corners, dimension() == 2 ? 2U : 4U);
    ASSERT_EQ(surface.cells.size() % corners, 0U);
    std::vector<int> uses(static_cast<std::size_t>(surface.points.cols()), 0);
    for (std::size_t c = 0; c < surface.cells.size(); c += corners) {
      std::vector<Vector> at;
      for (std::size_t k = c; k < c + corners; ++k) {
        ASSERT_GE(surface.cells[k], 0);
        ASSERT_LT(surface.cells[k], surface.points.cols());
        ++uses[std::size_t(surface.cells[k])];
        at.emplace_back(surface.points.col(surface.cells[k]));
      }
      has_poles = has_poles || surface.cells[c + corners - 1] == surface.cells[c + corners - 2];
      if (dimension() == 2) {
        const Vector along = at[1] - at[0], middle = 0.5 * (at[0] + at[1]);
        const Eigen::Vector2d left(-along[1], along[0]);
        EXPECT_NEAR(left.dot(Eigen::Vector2d(obstacle->normal(middle))), along.norm(), 0.02 * along.norm() + 1e-15);
        if (type() != "implicit") {
          EXPECT_EQ(surface.cells[c], c > 0 ? surface.cells[c - 1] : 0);
        }
      } else {
        const Eigen::Vector3d one = at[2] - at[0], other = at[3] - at[1], area = one.cross(other);
        const Vector middle = 0.25 * (at[0] + at[1] + at[2] + at[3]);
        EXPECT_GT(area.dot(Eigen::Vector3d(obstacle->normal(middle))),
                  (type() == "implicit" ? 0.5 : 0.97) * area.norm());
        if (type() != "implicit") {
          EXPECT_GT(area.norm(), 0.0);
        }
      }
    }
    EXPECT_EQ(std::ranges::count(uses, 0), 0);
    // About one node per cell, plus one at a pole or an end, instead of four per cell.
    const auto cells = Index(surface.cells.size() / corners);
    const bool has_rims = obstacle->shape().centre().size() == 0 || (dimension() == 3 && !has_poles);
    EXPECT_LE(surface.points.cols(), obstacle->shape().is_flat() ? 4 : has_rims ? 3 * cells / 2 : cells + 1);
    for (Index i = 0; i < surface.points.cols(); ++i) {
      for (Index k = 0; k < i && dimension() == 3 && type() == "sphere"; ++k)
        ASSERT_GT((surface.points.col(i) - surface.points.col(k)).lpNorm<1>(), 1e-9) << i << " is " << k << " again";
    }
  }
}

/// Planes stay beside the body when they move tangentially, and rotate; spheres follow their motion.
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

/// Returns the registered types, except surfaces from files, with the dimensions in which they exist.
std::vector<std::pair<std::string, Index>> types_and_dimensions() {
  std::vector<std::pair<std::string, Index>> all;
  for (const Index dimension : {2, 3}) {
    for (const std::string& type : obstacle_registry().names()) {
      if (type == "surface") continue;
      const bool is_in_space = dimension == 2 && has(message_of([&] { (void)shape_of(type, 2, "outside"); }),
                                                     "requires three dimensions; in two ");
      if (!is_in_space) all.emplace_back(type, dimension);
    }
  }
  return all;
}

/// Returns type, dimension and side of all obstacles, except surfaces from files.
std::vector<std::tuple<std::string, Index, std::string>> all_obstacles() {
  std::vector<std::tuple<std::string, Index, std::string>> all;
  for (const auto& [type, dimension] : types_and_dimensions()) {
    all.emplace_back(type, dimension, "outside");
    const auto& keys = obstacle_registry().find(type).keys;
    if (std::ranges::count(keys, "side", &Key::name) > 0) all.emplace_back(type, dimension, "inside");
  }
  return all;
}

/// The other tests ask the registry which types, dimensions and sides there are.
TEST(Obstacle, ShippedTypesKeepTheirDimensionsAndSides) {
  std::set<std::string> all;
  for (const auto& [type, dimension, side] : all_obstacles())
    all.insert(type + (dimension == 2 ? " 2 " : " 3 ") + side);
  for (const char* shipped : {"plane 2 outside", "plane 3 outside", "sphere 2 outside", "sphere 2 inside",
                              "sphere 3 outside", "sphere 3 inside", "cylinder 3 outside", "cylinder 3 inside",
                              "torus 3 outside", "torus 3 inside", "implicit 2 outside", "implicit 3 outside"})
    EXPECT_TRUE(all.contains(shipped)) << shipped;
}

INSTANTIATE_TEST_SUITE_P(All, Obstacles, testing::ValuesIn(all_obstacles()), [](const auto& info) {
  return std::get<0>(info.param) + "_" + std::get<2>(info.param) + "_" + std::to_string(std::get<1>(info.param)) + "d";
});

TEST(Obstacle, IsRefusedWithoutItsValuesOrWithOthers) {
  const auto message = [](const std::string& type, const Parameters& parameters) {
    return message_of([&] { (void)make_obstacle(type, parameters); });
  };
  EXPECT_EQ(message("teapot", {}),
            "unknown obstacle type \"teapot\"; known: \"plane\", \"sphere\", \"cylinder\", "
            "\"torus\", \"surface\" and \"implicit\"");
  EXPECT_EQ(message("sphere", {{"centre", Numbers{0.0, 0.0}}}),
            "obstacle type \"sphere\" needs the parameter \"radius\"");
  EXPECT_TRUE(has(message("plane", {{"centre", Numbers{0.0, 0.0}}}), "has no parameter \"centre\""));
  EXPECT_EQ(message("sphere", {{"centre", 1.0}, {"radius", 1.0}}),
            "obstacle type \"sphere\": the parameter \"centre\" is 1; it must be a vector of 2 or 3 numbers");
  EXPECT_EQ(message("sphere", {{"centre", Numbers{0.0, 0.0}}, {"radius", -1.0}}),
            "obstacle type \"sphere\": the parameter \"radius\" is -1; it must be a positive number");
  EXPECT_EQ(message("plane", {{"point", Numbers{0.0, 0.0}}, {"normal", Numbers{0.0, 0.0}}}),
            "the normal of a plane is zero");
  EXPECT_EQ(message("cylinder", {{"centre", Numbers{0.0, 0.0}}, {"axis", Numbers{0.0, 1.0}}, {"radius", 1.0}}),
            "a cylinder requires three dimensions; in two use a sphere, which is a circle there");
  EXPECT_TRUE(has(message("implicit", {{"expression", std::string("x + t")}}), "depends on t"));
  EXPECT_TRUE(has(message("implicit", {{"expression", std::string("2")}}), "does not depend on the position"));
}

/// x² has no slope where it is zero, and x − 3 has one everywhere.
TEST(Obstacle, RefusesAnExpressionWithoutASlope) {
  const auto gap = [](const std::string& expression) {
    return Obstacle(make_obstacle_shape("implicit", {{"expression", expression}}), nullptr, 0.0, Vector::Zero(2))
        .gap(Eigen::Vector2d(0.1, 0.2));
  };
  EXPECT_NEAR(gap("7*(x - 3)"), -2.9, 1e-14);
  EXPECT_THROW((void)gap("(x - 0.1)^2"), Error);
  expect_error({"vanishes at (0.05"}, [&] { (void)gap("(x - 0.05)^2"); });
}

/// Obstacles that rotate on curved paths: gaps at an instant are those of the
/// shape in its current pose, and the normal of a step accounts for the change of the gap relative to the motion of the
/// obstacle.
TEST(Obstacle, TurnsAndIsWhereItsPoseSays) {
  std::mt19937 random(5);
  const auto number = [&] { return 2.0 * double(random()) / 4294967296.0 - 1.0; };
  for (const auto& [type, dimension] : types_and_dimensions()) {
    SCOPED_TRACE(type);
    const std::vector<std::string> motion{"0.3*sin(2*t)", "0.1 - t^2", "0.2*t"}, turn{"0.4*t", "0.9*t + t^2", "-0.3*t"};
    std::vector<Expression> displacement, rotation;
    for (Index k = 0; k < dimension; ++k) displacement.emplace_back(motion[std::size_t(k)]);
    for (Index k = 0; k < (dimension == 2 ? 1 : 3); ++k) rotation.emplace_back(turn[std::size_t(k)]);
    const Vector about = Eigen::Vector3d(0.2, 0.5, -0.3).head(dimension);
    const Obstacle obstacle(shape_of(type, dimension, "outside"), make_path(displacement, rotation, dimension), 0.0,
                            about);
    ASSERT_TRUE(obstacle.rotates());
    EXPECT_FALSE(obstacle.has_constant_normals());
    const double start = 0.2, end = 0.35;
    const PosedObstacle before = obstacle.at(start), after = obstacle.at(end);
    int near = 0;
    for (int k = 0; k < 100; ++k) {
      SpaceVector of_shape(dimension), other(dimension);
      for (double& x : of_shape) x = 1.5 * number();
      for (double& x : other) x = 0.2 * number();
      other += of_shape;
      const SpaceVector from = before.pose().to_space(of_shape), to = after.pose().to_space(other);
      EXPECT_NEAR(before.gap(from), obstacle.shape().gap(of_shape), type == "implicit" ? 1e-11 : 1e-13);
      EXPECT_LT((before.pose().to_body_frame(from) - of_shape).norm(), 1e-14);
      const SpaceVector normal = normal_of_step(before, from, after, to);
      EXPECT_NEAR(normal.norm(), 1.0, 1e-14);
      // The velocity of the material at the mean position, over the step and at an instant.
      const SpaceVector own =
          (end - start) * obstacle.surface_velocity(0.5 * (from + to), 0.5 * (start + end), end - start);
      EXPECT_LT((own - motion_at(before.pose(), after.pose(), 0.5 * (from + to))).norm(), 1e-14);
      const SpaceVector at_start = obstacle.surface_velocity(from, start);
      const SpaceVector ahead = obstacle.pose(start + 1e-5).to_space(of_shape),
                        behind = obstacle.pose(start - 1e-5).to_space(of_shape);
      EXPECT_LT((at_start - (ahead - behind) / 2e-5).norm(), 1e-5);
      const double change = after.gap(to) - before.gap(from);
      EXPECT_GE(normal.dot(to - from - own) * change, -1e-12);
      // Far round, the normal is that of the end, or the displacement along it is zero.
      if (std::abs(normal.dot(to - from - own)) < 1e-12 || (normal - after.normal(to)).norm() < 1e-14) continue;
      ++near;
      EXPECT_GE(normal.dot(to - from - own) * change, -1e-13);
      EXPECT_GE(std::abs(normal.dot(to - from - own)), 0.2 * std::abs(change) - 1e-12);
      if (type == "plane") {
        EXPECT_LE(std::abs(normal.dot(to - from - own)), 1.02 * std::abs(change) + 1e-13);
      }
    }
    EXPECT_GT(near, 40);
  }
}

/// The rounding of differences must not appear as a velocity, whose direction friction at the start would have.
TEST(Obstacle, HasNoVelocityWhereItStartsFromRest) {
  const Vector about = Eigen::Vector2d(0.0, 0.0);
  const auto velocity = [&](const std::string& motion, double time_scale) {
    const Obstacle obstacle(shape_of("plane", 2, "outside"), make_path({Expression(motion), Expression("0")}, {}, 2),
                            0.0, about, time_scale);
    return obstacle.surface_velocity(about, 0.0)[0];
  };
  for (const double step : {1e-2, 1e-3, 5e-4, 2e-4, 1e-4, 7e-5, 3e-6, 1e-7, 1e-9}) {
    SCOPED_TRACE(step);
    for (const std::string rest : {"1.5e-4*(1 - cos(2*pi*t/0.2))", "4*t^2", "t^3", "0.1 + 3*t^2", "1e3*sin(t)^2"})
      EXPECT_EQ(velocity(rest, step), 0.0) << rest;
    EXPECT_NEAR(velocity("0.03*t + 0.2*t^2", step), 0.03, 1e-12 / step);
    EXPECT_NEAR(velocity("-2*sin(t)", step), -2.0, 1e-11 + 1e-12 / step);
  }
}

}  // namespace
}  // namespace ricochet::test_support
