#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <random>

#include "ricochet/base/error.hpp"
#include "support/case_run.hpp"
#include "support/contact_problems.hpp"
#include "support/errors.hpp"

/// @file Bodies whose contact nodes meet more planes at once than they have degrees of freedom: held by supports,
/// between planes that are nearly parallel, repeated or opposed. The motion of a step is still unique. A build with
/// sanitizers runs a sample; RICOCHET_RANDOM_CASES=100 a hundred times as many.

namespace ricochet::test_support {
namespace {

struct Pairing {
  const char *scheme, *mass;
  bool ends_outside;  ///< the gap condition holds at the end of the step
};
constexpr Pairing pairings[] = {{"newmark\"\npreset = \"trapezoidal", "equivalent", true},
                                {"newmark\"\npreset = \"textbook-half", "consistent", true},
                                {"newmark\"\npreset = \"trapezoidal", "lumped", true},
                                {"midpoint", "consistent", false},
                                {"klr-conserving", "consistent", false},
                                {"klr-conserving", "lumped", false},
                                {"semi-explicit", "equivalent-lumped", true}};

/// A block [0, 2] × [0, 1] of 12 × 3 squares.
std::string block_mesh() {
  return mesh_geometry("block",
                       "Rectangle(1)={0,0,0,2,1}; Transfinite Curve{1,3}=13; Transfinite Curve{2,4}=4; "
                       "Transfinite Surface{1}; Recombine Surface{1}; Physical Surface(\"body\")={1}; "
                       "Physical Curve(\"bottom\")={1};",
                       1.0, 1);
}

/// A plane facing the lower side, at the distance `room` at its nearest point x = `nearest`.
std::string plane(const std::string& name, const Eigen::Vector2d& normal, double nearest, double room, double friction,
                  const std::string& multipliers) {
  const Eigen::Vector2d point = Eigen::Vector2d(nearest, 0.0) - room * normal / normal.norm();
  return fmt::format(
      "[obstacle.{0}]\ntype = \"plane\"\npoint = [{1:.17g}, {2:.17g}]\nnormal = [{3:.17g}, {4:.17g}]\n"
      "[[contact]]\ngroup = \"bottom\"\nobstacle = \"{0}\"\nfriction = {5}\nmultipliers = \"{6}\"\n"
      "unstable_multipliers = \"allow\"\n",
      name, point[0], point[1], normal[0], normal[1], friction, multipliers);
}

std::string body(const std::string& mesh, const Pairing& pairing, const std::string& supports, double step, int steps) {
  return fmt::format(
      "[mesh]\nfile = \"{}\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nlambda = 100.0\nmu = 50.0\n{}"
      "[load]\ngravity = [0.3, -5.0]\n[initial]\nvelocity = [{}, -0.4]\n"
      "[mass]\ntype = \"{}\"\n[time]\nscheme = \"{}\"\nstep = {}\nend = {}\n",
      mesh, supports, supports.empty() ? 0.2 : 0.0, pairing.mass, pairing.scheme, step, step * steps);
}

const std::string held_along = "[[support]]\ngroup = \"bottom\"\ncomponents = [\"x\"]\nvalue = 0\n";

/// Expects that no contact point is inside an obstacle and that no reaction is tensile.
void expect_contact(CaseRun& run, bool ends_outside) {
  run.run(
      [&] {
        const StepEnd end(run);
        ASSERT_TRUE(end.displacement.allFinite());
        ASSERT_GE(end.normal.minCoeff(), 0.0);
        ASSERT_GE(end.gap.minCoeff(), ends_outside ? -1e-12 : -std::numeric_limits<double>::infinity());
      },
      false);
}

TEST(DependentObstacles, HoldAnyBodyUnderAnyScheme) {
  const std::string mesh = block_mesh();
  for (unsigned seed = 0; seed < samples(60); ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](auto... values) {
      const double all[] = {double(values)...};
      return all[random() % sizeof...(values)];
    };
    const Pairing& pairing = pairings[random() % std::size(pairings)];
    const char* const kinds[] = {"nodal", "nodal", "p0", "p1", "dual"};
    const std::string multipliers = kinds[random() % 5];
    const double friction = pick(0.0, 0.0, 0.0, 0.2);
    const double step = std::string(pairing.scheme) == "semi-explicit" ? pick(1e-3, 3e-3) : pick(1e-2, 1e-3, 3e-3);
    const double n = pick(0.2, 1e-7, 1e-3, 1e-12, 0.0, -0.2), room = pick(0.0, 1e-3, 1e-2);
    std::string text = body(mesh, pairing, random() % 3 != 0 ? held_along : "", step, 60);
    const auto add = [&](const std::string& name, const Eigen::Vector2d& normal, double extra) {
      // The plane is outside at all nodes.
      const double nearest = normal[0] > 0.0 ? 0.0 : normal[0] < 0.0 ? 2.0 : 1.0;
      text += plane(name, normal, nearest, room + extra, friction, multipliers);
    };
    add("floor", {0.0, 1.0}, 0.0);
    add("second", {n, 1.0}, pick(0.0, 1e-3, -0.5 * room));
    if (random() % 2 == 0) add("third", {-n - 0.1, 1.0}, pick(0.0, 1e-2));
    if (random() % 2 == 0) add("ceiling", {pick(0.0, n), -1.0}, pick(0.01, 0.1));
    SCOPED_TRACE(fmt::format("seed {}\n{}", seed, text));
    try {
      CaseRun run(text);
      expect_contact(run, pairing.ends_outside);
    } catch (const Error& problem) {
      ADD_FAILURE() << problem.what();
    }
    if (HasFailure()) return;
  }
}

/// A repeated plane, or an additional one with a tiny inclination, changes nothing, or as little: for a while, as
/// impacts of nodes with inertia amplify any difference.
TEST(DependentObstacles, APlaneTwiceIsAPlane) {
  const std::string mesh = block_mesh();
  for (const Pairing& pairing : pairings) {
    for (const std::string& supports : {held_along, std::string()}) {
      const std::string once =
          body(mesh, pairing, supports, 2e-3, 60) + plane("floor", {0.1, 1.0}, 0.0, 0.01, 0.0, "nodal");
      SCOPED_TRACE(once);
      CaseRun one(once);
      CaseRun two(once + plane("again", {0.1, 1.0}, 0.0, 0.01, 0.0, "nodal"));
      CaseRun inclined(once + plane("again", {0.1 + 1e-12, 1.0}, 0.0, 0.01, 0.0, "nodal"));
      double largest = 0.0, twice = 0.0, nearly = 0.0;
      bool released = false;
      Index most = 0, compared = 0;
      while (one.state().step < one.steps()) {
        for (CaseRun* run : {&one, &two, &inclined}) run->simulation().advance();
        const Vector& u = one.state().displacement;
        largest = std::max(largest, u.lpNorm<Eigen::Infinity>());
        // Schemes without contact at the end of a step amplify rounding from the first release on.
        const Index pressing = (one.state().forces.normal_reaction.array() > 0.0).count();
        released = released || pressing < most;
        most = std::max(most, pressing);
        if (released && !pairing.ends_outside) continue;
        twice = std::max(twice, (u - two.state().displacement).lpNorm<Eigen::Infinity>());
        nearly = std::max(nearly, (u - inclined.state().displacement).lpNorm<Eigen::Infinity>());
        ++compared;
      }
      EXPECT_GT(compared, 5);
      EXPECT_GT(largest, 0.01);
      EXPECT_LT(twice, 1e-9 * largest);
      EXPECT_LT(nearly, 1e-6 * largest);
    }
  }
}

/// A ceiling comes down on nodes on a floor: the step without remaining clearance reports the position and the
/// obstacles.
TEST(DependentObstacles, WithoutRoomAreNamed) {
  const std::string mesh = block_mesh();
  for (const double friction : {0.0, 0.2}) {
    std::string text = body(mesh, pairings[0], "", 2e-3, 500) +
                       plane("floor", {0.0, 1.0}, 1.0, 0.0, friction, "nodal") +
                       plane("press", {0.0, -1.0}, 1.0, 0.01, friction, "nodal");
    text.insert(text.find("[obstacle.press]\n") + 17, "velocity = [0.0, -0.3]\n");
    expect_error({"no motion meets the conditions of contact", "contact.0 (normal (0, 1))",
                  "contact.1 (normal (0, -1))", "step 17 (t = 0.034", "(reference position)"},
                 [&] { CaseRun(text).run([] {}, false); });
  }
}

}  // namespace
}  // namespace ricochet::test_support
