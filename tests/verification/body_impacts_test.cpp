#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/simulation/impact/impacts.hpp"
#include "ricochet/simulation/impact/restitution.hpp"
#include "ricochet/simulation/impact/rigid_bodies.hpp"
#include "support/case_run.hpp"
#include "support/strip.hpp"

// Impacts of two bodies: bars with an exact solution, balances of momentum, a body in several contacts at a time.

namespace ricochet::test_support::body_impacts_test {

ImpactRecorder make_recorder(CaseRun& run) {
  const ConnectedBodies bodies = find_connected_bodies(run.model().space);
  return {run.problem(),  run.scheme(),
          run.state(),    run.model().contact_pairs,
          bodies.of_node, wave_crossing_times(run.model().body, bodies)};
}

std::vector<RigidMotionState> motion_of(const CaseRun& run) {
  const ConnectedBodies bodies = find_connected_bodies(run.model().space);
  return RigidBodies(run.problem(), bodies.of_node, bodies.count)
      .motion(run.state().velocity, run.state().displacement);
}

std::vector<Impact> impacts_of(CaseRun& run) {
  ImpactRecorder recorder = make_recorder(run);
  run.run([&] { recorder.enter_step(run.state(), run.simulation().account().method_energy(run.state())); }, false);
  return recorder.impacts();
}

std::vector<Impact> impacts_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  CaseRun run(text, overrides);
  return impacts_of(run);
}

std::string part(const std::string& name, const std::string& mesh, double x, const std::string& velocity) {
  return fmt::format("[part.{}]\nfile = \"{}\"\nmove = [{:.17g}, 0.0]\nvelocity = {}\n", name, mesh, x, velocity);
}

/// Material with equal Young's modulus and density: the wave speed is 1.
std::string material(const std::string& part, double stiffness) {
  return fmt::format("[[material]]\ngroup = \"{}.body\"\nyoung = {}\npoisson = 0.0\ndensity = {}\n", part, stiffness,
                     stiffness);
}

std::string time_section(int cells, double end) {
  return fmt::format(
      "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = {:.17g}\n"
      "end = {:.17g}\n",
      0.5 / cells, end);
}

/// Bars of length 1, the first one three times as heavy and stiff, approaching at the speed 1 from a gap of 0.1.
std::string two_bars(int cells, const std::string& contact) {
  const std::string mesh = strip_mesh(0.0, 1.0, cells);
  return part("one", mesh, 0.0, "[1.0, 0.0]") + part("two", mesh, 1.1, "[0.0, 0.0]") + material("one", 3.0) +
         material("two", 1.0) + "[[support]]\ngroup = [\"one.sides\", \"two.sides\"]\ncomponents = [\"y\"]\n" +
         "[[contact]]\n" + contact + time_section(cells, 4.0);
}

const std::string one_against_two = "group = \"one.right\"\nagainst = \"two.left\"\n";

/// Both far ends reflect their waves at the same time, so that the bars separate after 2L/c without vibrations: the
/// relative velocity is reversed, and the velocities are 1/2 and 3/2. The loss in a mesh, 1 − e, remains as
/// oscillations behind the fronts and is proportional to the size of the cells.
TEST(BodyImpacts, OfBarsOfOneTransitTimeGiveTheApproachBack) {
  double last_error = 1.0;
  for (const int cells : {10, 20, 40, 80}) {
    const std::vector<Impact> found = impacts_of(two_bars(cells, one_against_two));
    ASSERT_EQ(found.size(), 1U) << cells;
    const Impact& impact = found[0];
    EXPECT_TRUE(impact.ended);
    EXPECT_EQ(impact.obstacle, "");
    EXPECT_EQ(impact.body, 0);
    ASSERT_TRUE(impact.other.has_value());
    EXPECT_EQ(impact.other->number, 1);
    const double mass = 3.0 / cells;
    EXPECT_NEAR(impact.mass, mass, 1e-12 * mass);
    EXPECT_NEAR(impact.other->mass, mass / 3.0, 1e-12 * mass);
    EXPECT_NEAR(impact.begin, 0.1, 1.0 / cells);
    EXPECT_NEAR(impact.end - impact.begin, 2.0, 2.0 / cells);
    EXPECT_NEAR(impact.normal()[0], -1.0, 1e-12) << "out of the other bar";
    EXPECT_NEAR(impact.normal_velocity_before(), -1.0, 1e-10);
    ASSERT_TRUE(impact.restitution().has_value()) << cells;
    const double error = std::abs(*impact.restitution() - 1.0);
    EXPECT_LT(error, last_error) << cells;
    last_error = error;
    // The impulses are opposite and the only ones, up to rounding of the velocities.
    const Eigen::Vector3d of_one = impact.mass * (impact.after.velocity - impact.before.velocity);
    const Eigen::Vector3d of_two = impact.other->mass * (impact.other->after.velocity - impact.other->before.velocity);
    EXPECT_NEAR((of_one - impact.impulse).norm(), 0.0, 1e-11 * mass);
    EXPECT_NEAR((of_two + impact.impulse).norm(), 0.0, 1e-11 * mass);
    EXPECT_GT(impact.impulse.norm(), 0.4 * mass);
    EXPECT_NEAR(impact.before.kinetic_energy, 0.5 * mass, 1e-10 * mass);
    EXPECT_NEAR(impact.other->before.kinetic_energy, 0.0, 1e-12 * mass);
    EXPECT_LE(impact.other->after.rigid_kinetic_energy, impact.other->after.kinetic_energy * (1.0 + 1e-12));
    EXPECT_GT(impact.other->after.rigid_kinetic_energy, 0.9 * 0.5 * 1.5 * 1.5 * impact.other->mass);
  }
  EXPECT_LT(last_error, 0.01);
}

/// The first body is that of the `group` in the case, whichever group carries the multipliers.
TEST(BodyImpacts, NameTheBodyOfTheGroupFirst) {
  const Impact usual = impacts_of(two_bars(10, one_against_two + "multipliers_on = \"group\"\n")).at(0);
  const Impact other_side = impacts_of(two_bars(10, one_against_two + "multipliers_on = \"against\"\n")).at(0);
  EXPECT_EQ(other_side.body, 0);
  EXPECT_EQ(other_side.other->number, 1);
  EXPECT_NEAR((other_side.impulse - usual.impulse).norm(), 0.0, 1e-9 * usual.impulse.norm());
  EXPECT_NEAR((other_side.normal() - usual.normal()).norm(), 0.0, 1e-12);
  for (const std::string side : {"group", "against"}) {
    const Impact exchanged =
        impacts_of(two_bars(10, "group = \"two.left\"\nagainst = \"one.right\"\nmultipliers_on = \"" + side + "\"\n"))
            .at(0);
    EXPECT_EQ(exchanged.body, 1) << side;
    EXPECT_EQ(exchanged.other->number, 0) << side;
    EXPECT_NEAR((exchanged.impulse + usual.impulse).norm(), 0.0, 1e-9 * usual.impulse.norm()) << side;
    EXPECT_NEAR(*exchanged.restitution(), *usual.restitution(), 1e-9) << side;
  }
}

/// Equal bars that meet at opposite velocities move like each of them at a wall between them, to rounding, oscillations
/// of the mesh included.
TEST(BodyImpacts, OfEqualBarsAreThoseAtAWall) {
  const std::string mesh = strip_mesh(0.0, 1.0, 20);
  const std::string sides = "components = [\"y\"]\n", end = time_section(20, 4.0);
  const std::string both = part("one", mesh, 0.0, "[1.0, 0.0]") + part("two", mesh, 1.2, "[-1.0, 0.0]") +
                           material("one", 2.0) + material("two", 2.0) +
                           "[[support]]\ngroup = [\"one.sides\", \"two.sides\"]\n" + sides + "[[contact]]\n" +
                           one_against_two + end;
  const std::string alone = part("one", mesh, 0.0, "[1.0, 0.0]") + material("one", 2.0) +
                            "[[support]]\ngroup = \"one.sides\"\n" + sides +
                            "[obstacle.wall]\ntype = \"plane\"\npoint = [1.1, 0.0]\nnormal = [-1.0, 0.0]\n"
                            "[[contact]]\ngroup = \"one.right\"\nobstacle = \"wall\"\n" +
                            end;
  const std::vector<Impact> of_two = impacts_of(both), at_wall = impacts_of(alone);
  ASSERT_EQ(of_two.size(), 1U);
  ASSERT_EQ(at_wall.size(), 1U);
  EXPECT_NEAR(of_two[0].begin, at_wall[0].begin, 1e-12);
  EXPECT_NEAR(of_two[0].end, at_wall[0].end, 1e-12);
  EXPECT_NEAR((of_two[0].impulse - at_wall[0].impulse).norm(), 0.0, 1e-10 * at_wall[0].impulse.norm());
  EXPECT_NEAR(of_two[0].largest_force, at_wall[0].largest_force, 1e-10 * at_wall[0].largest_force);
  EXPECT_NEAR(*of_two[0].restitution(), *at_wall[0].restitution(), 1e-10);
  EXPECT_NEAR(of_two[0].normal_velocity_before(), 2.0 * at_wall[0].normal_velocity_before(), 1e-10);
  EXPECT_NEAR((of_two[0].other->after.velocity + of_two[0].after.velocity).norm(), 0.0, 1e-10);
}

/// A bar that is struck at both ends while it falls on a floor: an impact for each of the three.
TEST(BodyImpacts, AreOneForEachBodyAndObstacle) {
  const std::string mesh = strip_mesh(0.0, 1.0, 10);
  const std::string text = part("middle", mesh, 0.0, "[0.0, -0.1]") + part("left", mesh, -1.01, "[1.0, 0.0]") +
                           part("right", mesh, 1.01, "[-1.0, 0.0]") + material("middle", 1.0) + material("left", 2.0) +
                           material("right", 1.0) +
                           "[[support]]\ngroup = [\"left.sides\", \"right.sides\"]\ncomponents = [\"y\"]\n" +
                           "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, -0.001]\nnormal = [0.0, 1.0]\n"
                           "[[contact]]\ngroup = \"left.right\"\nagainst = \"middle.left\"\nmultipliers = \"nodal\"\n"
                           "[[contact]]\ngroup = \"right.left\"\nagainst = \"middle.right\"\nmultipliers = \"nodal\"\n"
                           "[[contact]]\ngroup = \"middle.sides\"\nobstacle = \"floor\"\n" +
                           time_section(10, 4.0);
  CaseRun run(text, {"mass.type=consistent"});  // almost all nodes of the middle bar are contact nodes
  const std::vector<RigidMotionState> before = motion_of(run);
  const std::vector<Impact> found = impacts_of(run);
  const std::vector<RigidMotionState> after = motion_of(run);
  const auto pairs = [&](int body, int other, const std::string& obstacle) {
    std::vector<Impact> result;
    std::ranges::copy_if(found, std::back_inserter(result), [&](const Impact& impact) {
      return impact.body == body && (impact.other ? impact.other->number : -1) == other && impact.obstacle == obstacle;
    });
    return result;
  };
  const int middle = 0, left = 1, right = 2;
  const std::vector<Impact> from_left = pairs(left, middle, ""), from_right = pairs(right, middle, ""),
                            floor = pairs(middle, -1, "floor");
  EXPECT_EQ(from_left.size() + from_right.size() + floor.size(), found.size());
  ASSERT_FALSE(from_left.empty() || from_right.empty() || floor.empty());
  EXPECT_NEAR(from_left[0].begin, from_right[0].begin, 0.1);
  EXPECT_LT(from_left[0].impulse[0], 0.0);
  EXPECT_GT(from_right[0].impulse[0], 0.0);
  EXPECT_GT(floor[0].impulse[1], 0.0);
  // Impulse on the middle bar from all three contacts, to rounding.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Impact& impact : from_left) sum -= impact.impulse;
  for (const Impact& impact : from_right) sum -= impact.impulse;
  for (const Impact& impact : floor) sum += impact.impulse;
  const double mass = floor[0].mass;
  EXPECT_NEAR((mass * (after[0].velocity - before[0].velocity) - sum).norm(), 0.0, 1e-10 * mass);
  EXPECT_GT(sum.norm(), 0.01 * mass);
}

/// A bar of length 1 and speed 1 hits an equal bar whose far end is held: together they are a bar of length 2 that has
/// hit a wall, half of it at rest, and after 4L/c the first one returns at its full speed. The forces of the wall give
/// the second bar as large an impulse as the first one, which is not part of the approach.
TEST(BodyImpacts, OfABarAgainstAHeldOneGiveItsSpeedBack) {
  const auto text = [](int cells, const std::string& contact, const std::string& place) {
    const std::string mesh = strip_mesh(0.0, 1.0, cells);
    return part("one", mesh, 0.0, "[1.0, 0.0]") + part("two", mesh, 1.1, "[0.0, 0.0]") + material("one", 1.0) +
           material("two", 1.0) + "[[support]]\ngroup = [\"one.sides\", \"two.sides\"]\ncomponents = [\"y\"]\n" +
           "[[support]]\ngroup = \"two.right\"\ncomponents = [\"x\"]\n" + place + "[[contact]]\n" + contact +
           time_section(cells, 6.0);
  };
  double last_error = 0.2;
  for (const int cells : {10, 20, 40, 80}) {
    const std::vector<Impact> found = impacts_of(text(cells, one_against_two, ""));
    ASSERT_EQ(found.size(), 1U) << cells;
    EXPECT_FALSE(found[0].held);
    EXPECT_TRUE(found[0].other_is_ground());
    ASSERT_TRUE(found[0].restitution().has_value()) << why_no_restitution(found[0]);
    EXPECT_NEAR(found[0].normal_velocity_before(), -1.0, 1e-9);
    EXPECT_EQ(found[0].approach_mass(), found[0].mass);
    EXPECT_NEAR(found[0].end - found[0].begin, 4.0, 6.0 / cells);
    const double error = std::abs(1.0 - *found[0].restitution());
    EXPECT_LT(error, 0.75 * last_error) << cells;
    last_error = error;
  }
  // The same case with the roles of the bars exchanged.
  const std::vector<Impact> exchanged = impacts_of(text(80, "group = \"two.left\"\nagainst = \"one.right\"\n", ""));
  ASSERT_EQ(exchanged.size(), 1U);
  EXPECT_TRUE(exchanged[0].is_ground());
  ASSERT_TRUE(exchanged[0].restitution().has_value()) << why_no_restitution(exchanged[0]);
  EXPECT_NEAR(std::abs(1.0 - *exchanged[0].restitution()), last_error, 1e-6);
  // A second bar that is held by a moving support is not part of the ground.
  const std::vector<Impact> moved = impacts_of(text(10, one_against_two, "value = \"-1e-3*t*t\"\n"));
  ASSERT_GE(moved.size(), 1U);
  EXPECT_FALSE(moved[0].other->held);
  EXPECT_DOUBLE_EQ(moved[0].approach_mass(), 0.5 * moved[0].mass);
}

/// Resuming from a snapshot gives the same numbers, also for the other body.
TEST(BodyImpacts, GoOnFromASnapshot) {
  CaseRun run(two_bars(10, one_against_two));
  ImpactRecorder recorder = make_recorder(run);
  std::vector<ImpactRecorder> resumed;
  run.run(
      [&] {
        const double method_energy = run.simulation().account().method_energy(run.state());
        recorder.enter_step(run.state(), method_energy);
        for (ImpactRecorder& other : resumed) other.enter_step(run.state(), method_energy);
        if (run.state().step % 10 != 0) return;
        Snapshot snapshot;
        recorder.persist(snapshot.saver("impacts"));
        resumed.push_back(make_recorder(run));
        resumed.back().persist(snapshot.loader("impacts"));
      },
      false);
  ASSERT_EQ(recorder.impacts().size(), 1U);
  ASSERT_GT(resumed.size(), 4U);
  for (const ImpactRecorder& other : resumed) {
    ASSERT_EQ(other.impacts().size(), 1U);
    EXPECT_EQ(other.impacts()[0].other->after.velocity, recorder.impacts()[0].other->after.velocity);
    EXPECT_EQ(other.impacts()[0].impulse, recorder.impacts()[0].impulse);
  }
  EXPECT_NE(recorder.impacts()[0].other->after.velocity[0], 0.0);
}

}  // namespace ricochet::test_support::body_impacts_test
