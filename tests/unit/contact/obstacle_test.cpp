#include "ricochet/contact/obstacle.hpp"

#include <gtest/gtest.h>

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

/// Surfaces for pictures lie on the obstacle, which has moved by then.
TEST_P(Obstacles, HaveSurfacesWhereTheyAre) {
  const auto obstacle = make();
  constexpr double time = 0.5;
  const SpaceVector moved = obstacle->translation(time);
  EXPECT_TRUE(obstacle->moves());
  EXPECT_GT(moved.norm(), 0.1);
  const Points surface = obstacle->surface(random_point(), 0.3, time);
  ASSERT_GT(surface.cols(), 1);
  for (Index k = 0; k < surface.cols(); ++k)
    EXPECT_NEAR(obstacle->gap(SpaceVector(surface.col(k)) - moved), 0.0, 1e-14);
  // What the material does, the surface does along its normal.
  const Vector foot = surface.col(0);
  const Vector normal = obstacle->normal(foot - moved);
  EXPECT_NEAR(obstacle->surface_velocity(foot, time).dot(normal), moved.dot(normal) / time, 1e-14);
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
