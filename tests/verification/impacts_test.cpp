#include "ricochet/simulation/impact/impacts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "ricochet/simulation/monitor/peak_stress.hpp"
#include "support/case_run.hpp"
#include "support/strip.hpp"
#include "support/thrown_body.hpp"

// Impacts detected in a run: bars with exact solutions, momentum balances of thrown bodies, moving obstacles, several
// bodies, checkpoints; and the largest stress.

namespace ricochet::test_support::impacts_test {

const std::string trapezoidal = "scheme = \"newmark\"\npreset = \"trapezoidal\"\n";

ImpactRecorder make_recorder(CaseRun& run) {
  const ConnectedBodies bodies = find_connected_bodies(run.model().space);
  return {run.problem(),  run.scheme(),
          run.state(),    run.model().contact_pairs,
          bodies.of_node, wave_crossing_times(run.model().body, bodies)};
}

double method_energy(CaseRun& run) { return run.simulation().account().method_energy(run.state()); }

std::vector<Impact> impacts_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  CaseRun run(text, overrides);
  ImpactRecorder recorder = make_recorder(run);
  run.run([&] { recorder.enter_step(run.state(), method_energy(run)); }, false);
  return recorder.impacts();
}

/// E = 900, ρ = 1, L = 10, so c = 30, from a gap of 5.
std::string bar(int cells, const std::string& rest) {
  const double step = 0.5 * 10.0 / cells / 30.0;
  return strip_case(strip_mesh(5.0, 10.0, cells), 900.0, 1.0) + rest + "[mass]\ntype = \"equivalent\"\n[time]\n" +
         trapezoidal + fmt::format("step = {:.17g}\n", step);
}

/// A bar that hits a wall at the speed v is in contact for 2L/c and leaves at v: impulse 2mv, largest force ρcv A.
TEST(Impacts, OfABarAgainstAWall) {
  double last_error = 1.0;
  for (const int cells : {25, 50, 100}) {
    const std::vector<Impact> found = impacts_of(bar(cells, "[initial]\nvelocity = [-10.0, 0.0]\n"), {"time.end=1.6"});
    ASSERT_EQ(found.size(), 1u) << cells;
    const Impact& impact = found[0];
    const double step = 0.5 * 10.0 / cells / 30.0, mass = 10.0 * 10.0 / cells;
    EXPECT_TRUE(impact.ended);
    EXPECT_EQ(impact.obstacle, "wall");
    EXPECT_NEAR(impact.begin, 0.5, step);
    EXPECT_NEAR(impact.end - impact.begin, 2.0 * 10.0 / 30.0, 2.0 * step) << cells;
    EXPECT_NEAR(impact.mass, mass, 1e-12 * mass);
    EXPECT_NEAR(impact.normal_velocity_before(), -10.0, 1e-10);
    EXPECT_NEAR(impact.normal()[0], 1.0, 1e-14);
    // The whole end of the strip, which has two nodes.
    EXPECT_EQ(impact.contact_points, 2);
    EXPECT_EQ(impact.all_contact_points, 2);
    EXPECT_FALSE(impact.is_coarse());
    ASSERT_EQ(impact.first_position.size(), 2u);
    EXPECT_EQ(impact.first_position[0], 5.0);
    ASSERT_TRUE(impact.restitution().has_value());
    // The lost energy remains in the mesh as oscillations.
    const double error = std::abs(*impact.restitution() - 1.0);
    EXPECT_LT(error, last_error) << cells;
    last_error = error;
    EXPECT_NEAR(impact.impulse[0], mass * 10.0 * (1.0 + *impact.restitution()), 1e-10 * mass * 20.0);
    EXPECT_NEAR(impact.before.kinetic_energy, 0.5 * mass * 100.0, 1e-10 * mass * 100.0);
    EXPECT_NEAR(impact.before.rigid_kinetic_energy, impact.before.kinetic_energy, 1e-10 * mass * 100.0);
    EXPECT_LE(impact.after.rigid_kinetic_energy, impact.after.kinetic_energy);
  }
  EXPECT_LT(last_error, 0.02);
}

/// A bar dropped from rest with g = 10 bounces for ever with the period 8/3: three impacts, each of the duration 2/3.
TEST(Impacts, OfABarThatBounces) {
  const std::vector<Impact> found = impacts_of(bar(200, "[load]\ngravity = [-10.0, 0.0]\n"), {"time.end=7.5"});
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double begin = 1.0 + double(i) * 8.0 / 3.0;
    EXPECT_NEAR(found[i].begin, begin, 0.01 * begin) << i;
    EXPECT_NEAR(found[i].end, begin + 2.0 / 3.0, 0.01 * begin) << i;
    EXPECT_NEAR(*found[i].restitution(), 1.0, 0.03) << i;
  }
}

/// A moving wall that hits the bar and a moving bar that hits the wall are the same impact.
TEST(Impacts, DoNotDependOnWhoMoves) {
  const std::string moving = bar(50, "");
  const std::string wall = "normal = [1.0, 0.0]\n";
  std::string driven = moving;
  driven.insert(driven.find(wall) + wall.size(), "velocity = [10.0, 0.0]\n");
  const std::vector<Impact> thrown = impacts_of(bar(50, "[initial]\nvelocity = [-10.0, 0.0]\n"), {"time.end=1.6"});
  const std::vector<Impact> hit = impacts_of(driven, {"time.end=1.6"});
  ASSERT_EQ(thrown.size(), 1u);
  ASSERT_EQ(hit.size(), 1u);
  EXPECT_NEAR(hit[0].obstacle_velocity, 10.0, 1e-9);
  EXPECT_NEAR(hit[0].begin, thrown[0].begin, 1e-9);
  EXPECT_NEAR(hit[0].end, thrown[0].end, 1e-9);
  EXPECT_NEAR(*hit[0].restitution(), *thrown[0].restitution(), 1e-8);
  EXPECT_NEAR(hit[0].largest_force, thrown[0].largest_force, 1e-7 * thrown[0].largest_force);
}

struct SchemeOfImpacts {
  std::string time, mass;
  double steps_more;  ///< number of steps in which the force at one instant acts, minus one
};

std::vector<SchemeOfImpacts> schemes() {
  return {{trapezoidal, "equivalent", 1.0},
          {"scheme = \"newmark\"\npreset = \"textbook-half\"\n", "consistent", 0.0},
          {"scheme = \"midpoint\"\n", "consistent", 0.0},
          {"scheme = \"klr-conserving\"\n", "consistent", 0.0},
          {"scheme = \"semi-explicit\"\n", "equivalent-lumped", 1.0}};
}

/// Bodies thrown with a spin against an oblique plane with friction: before the impact the motion has the initial
/// velocity; the impulse is the change of momentum without gravity, and its moment the change of angular momentum.
TEST(Impacts, BalanceMomentumInEveryScheme) {
  const std::vector<ThrownBody> bodies = thrown_bodies();
  for (const std::size_t which : {0u, 3u}) {
    for (const SchemeOfImpacts& scheme : schemes()) {
      if (which == 3 && scheme.mass == "consistent" && scheme.time.find("midpoint") == std::string::npos) continue;
      const std::string trace = bodies[which].name + " " + scheme.time;
      CaseRun run(thrown_case(bodies[which], scheme.mass, scheme.time, "friction = 0.3\n"),
                  {which == 0 ? "load.gravity=[0.0, 0.0]" : "load.gravity=[0.0, 0.0, 0.0]", "time.end=3.0"});
      ImpactRecorder recorder = make_recorder(run);
      MomentumAccount account(run.problem(), run.scheme(), run.state());
      run.run(
          [&] {
            recorder.enter_step(run.state(), method_energy(run));
            account.enter_step(run.state());
          },
          false);
      const std::vector<Impact> found = recorder.impacts();
      ASSERT_EQ(found.size(), 1u) << trace;
      const Impact& impact = found[0];
      ASSERT_TRUE(impact.ended) << trace;
      const RigidBody& body = recorder.bodies()[0];
      const double size = impact.mass * impact.before.velocity.norm();
      // v = v₀ + ω × x with ω = 0.2 about z, or −0.2 about y (and a shear of 0.2 without rotation).
      const Eigen::Vector3d spin = which == 0 ? Eigen::Vector3d(0.0, 0.0, 0.2) : Eigen::Vector3d(0.0, -0.2, 0.0);
      EXPECT_LT((impact.before.spin - spin).norm(), 1e-12) << trace;
      const Eigen::Vector3d start = which == 0
                                        ? Eigen::Vector3d(0.1 - 0.2 * body.centre[1], -0.5 + 0.2 * body.centre[0], 0.0)
                                        : Eigen::Vector3d(0.1 - 0.2 * body.centre[2], 0.1, -0.5 + 0.2 * body.centre[0]);
      EXPECT_LT((impact.before.velocity - start).norm(), 1e-12) << trace;
      EXPECT_NEAR(impact.before.kinetic_energy, impact.before.rigid_kinetic_energy, 1e-12 * size) << trace;
      EXPECT_LT((impact.impulse - account.impulse().force).norm(), 1e-13 * size) << trace;
      EXPECT_LT(impact.other_impulse().norm(), 1e-11 * size) << trace;
      const Eigen::Vector3d moment = account.impulse().moment - body.centre.cross(account.impulse().force);
      Eigen::Vector3d change = body.inertia * (impact.after.spin - impact.before.spin);
      if (which == 0) change[0] = change[1] = 0.0;
      EXPECT_LT((change - moment).norm(), 1e-10 * size) << trace;
      EXPECT_GT(change.norm(), 1e-3 * size) << trace;
      // Friction acts against the slip, within the bound of Coulomb's law.
      EXPECT_LT((impact.impulse - impact.normal_impulse).norm(), 0.3 * impact.normal_impulse.norm() * (1.0 + 1e-12));
    }
  }
}

/// The impulse of other forces is due to gravity: m g times the duration of the steps of the impact.
TEST(Impacts, TellGravitysPart) {
  const std::vector<ThrownBody> bodies = thrown_bodies();
  for (const SchemeOfImpacts& scheme : schemes()) {
    if (scheme.mass == "consistent") continue;  // contact may chatter, and each return adds a step
    const std::vector<Impact> found = impacts_of(thrown_case(bodies[0], scheme.mass, scheme.time), {"time.end=4.0"});
    ASSERT_FALSE(found.empty()) << scheme.time;
    const Impact& impact = found[0];
    ASSERT_TRUE(impact.ended);
    ASSERT_EQ(impact.intervals, 1) << scheme.time;
    const double time = impact.end - impact.begin + 0.01 * scheme.steps_more;
    const Eigen::Vector3d expected = impact.mass * time * Eigen::Vector3d(0.3, -1.0, 0.0);
    EXPECT_LT((impact.other_impulse() - expected).norm(), 1e-11 * impact.impulse.norm()) << scheme.time;
  }
}

/// Two discs in one mesh, of different sizes and heights: each has its own impacts.
TEST(Impacts, AreOfOneBodyEach) {
  const std::string mesh =
      mesh_geometry("pair",
                    "Disk(1)={0,1.02,0,1}; Disk(2)={3,0.8,0,0.5}; Physical Surface(\"body\")={1,2}; "
                    "Physical Curve(\"contact\")={1,2};",
                    0.3, 1);
  const std::string text = thrown_case({"pair", 2, 1, mesh}, "equivalent", trapezoidal);
  const std::vector<Impact> found = impacts_of(text, {"load.gravity=[0.0, 0.0]", "initial.velocity=[0.0, -0.5]",
                                                      "time.end=4.0", "obstacle.plane.normal=[0.0, 1.0]"});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].body, 0);
  EXPECT_EQ(found[1].body, 1);
  EXPECT_NEAR(found[0].begin, 0.04, 0.02);
  EXPECT_NEAR(found[1].begin, 0.6, 0.03);
  // The discs are approximately regular polygons: their masses differ by a factor of four.
  EXPECT_NEAR(found[0].mass / found[1].mass, 4.0, 0.4);
  for (const Impact& impact : found)
    EXPECT_LT(impact.other_impulse().norm(), 1e-11 * impact.impulse.norm()) << impact.body;
}

/// A body that rests on the floor from the start: one impact, without restitution, that does not end.
TEST(Impacts, OfABodyAtRest) {
  const std::vector<Impact> found =
      impacts_of(bar(10, "[load]\ngravity = [-10.0, 0.0]\n[initial]\ndisplacement = \"static\"\n"),
                 {"time.end=2.0", "obstacle.wall.point=[5.0, 0.0]"});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].from_start);
  EXPECT_FALSE(found[0].ended);
  EXPECT_EQ(found[0].begin, 0.0);
  EXPECT_FALSE(found[0].restitution().has_value());
  // It carries the weight m g, L h ρ g with h = L/10, all the time.
  EXPECT_NEAR(found[0].impulse[0], 100.0 * 2.0, 1e-9 * 200.0);
}

/// A bar that rests on the floor and is thrown up so fast that its weight cannot press it down: only the force at t = 0
/// acts, its weight, for half a step. The interval of contact equals the time of contact.
TEST(Impacts, OfABodyThatLeavesInTheFirstStep) {
  for (const char* scheme : {"scheme = \"newmark\"\npreset = \"trapezoidal\"\n", "scheme = \"semi-explicit\"\n"}) {
    std::string text = bar(10,
                           "[load]\ngravity = [-10.0, 0.0]\n[initial]\ndisplacement = \"static\"\n"
                           "velocity = [10.0, 0.0]\n");
    text.replace(text.find(trapezoidal), trapezoidal.size(), scheme);
    std::vector<std::string> overrides{"time.end=0.5", "obstacle.wall.point=[5.0, 0.0]"};
    if (scheme != trapezoidal) overrides.push_back("mass.type=equivalent-lumped");
    const std::vector<Impact> found = impacts_of(text, overrides);
    ASSERT_EQ(found.size(), 1u) << scheme;
    const Impact& impact = found[0];
    const double step = 0.5 * 1.0 / 30.0;
    EXPECT_TRUE(impact.from_start && impact.ended) << scheme;
    EXPECT_EQ(impact.begin, 0.0) << scheme;
    EXPECT_NEAR(impact.contact_time, 0.5 * step, 1e-14 * step) << scheme;
    EXPECT_EQ(impact.end, impact.contact_time) << scheme;
    EXPECT_NEAR(impact.impulse[0], 100.0 * 0.5 * step, 1e-9 * 100.0 * step) << scheme;
  }
}

/// Resuming from a snapshot gives the same numbers.
TEST(Impacts, GoOnFromASnapshot) {
  const std::string text = thrown_case(thrown_bodies()[0], "equivalent", trapezoidal, "friction = 0.3\n");
  CaseRun run(text, {"time.end=4.0"});
  ImpactRecorder recorder = make_recorder(run);
  std::vector<ImpactRecorder> resumed;
  run.run(
      [&] {
        recorder.enter_step(run.state(), method_energy(run));
        for (ImpactRecorder& other : resumed) other.enter_step(run.state(), method_energy(run));
        if (run.state().step % 60 != 0) return;
        Snapshot snapshot;
        recorder.persist(snapshot.saver("impacts"));
        resumed.push_back(make_recorder(run));
        resumed.back().persist(snapshot.loader("impacts"));
      },
      false);
  const auto numbers = [](ImpactRecorder& of) {
    Snapshot snapshot;
    of.persist(snapshot.saver("impacts"));
    return snapshot.values();
  };
  ASSERT_GT(recorder.impacts().size(), 0u);
  ASSERT_GT(resumed.size(), 4u);
  for (ImpactRecorder& other : resumed) EXPECT_TRUE(numbers(other) == numbers(recorder));
}

/// If the time share allows it, every state is evaluated; otherwise the states of frames and some others, within the
/// share.
TEST(PeakStress, IsThatOfTheStatesThatWereLookedAt) {
  CaseRun run(bar(50, "[initial]\nvelocity = [-10.0, 0.0]\n"), {"time.end=1.6"});
  const Body& body = run.model().body;
  PeakStress all(body, 1e30), some(body, 20.0 * 20.0 * double(run.model().mesh.cell_count())), frames(body, 0.0);
  std::vector<double> stress, density;
  double largest = 0.0, largest_of_frames = 0.0;
  long states = 0, frame_count = 0, largest_step = 0;
  run.run([&] {
    const bool is_frame = run.state().step % 40 == 0;
    for (PeakStress* peak : {&all, &some, &frames}) peak->enter(run.state(), is_frame);
    CellStress(body).evaluate(run.state().displacement, stress, density);
    ++states;
    frame_count += is_frame ? 1 : 0;
    for (std::size_t i = 0; i < density.size(); ++i) {
      const double own = von_mises_stress(stress.data() + tensor_components * i);
      if (own > largest) largest_step = run.state().step;
      largest = std::max(largest, own);
      if (is_frame) largest_of_frames = std::max(largest_of_frames, own);
    }
  });
  EXPECT_EQ(all.result().evaluations, states);
  EXPECT_EQ(all.result().states, states);
  EXPECT_EQ(all.result().von_mises, largest);
  EXPECT_EQ(all.result().step, largest_step);
  // ν = 0: the stress of the front is E v/c = 300 along the bar and zero across; the mesh overshoots.
  EXPECT_GT(largest, 300.0);
  EXPECT_LT(largest, 600.0);
  EXPECT_EQ(frames.result().evaluations, frame_count);
  EXPECT_EQ(frames.result().von_mises, largest_of_frames);
  EXPECT_GT(some.result().evaluations, frame_count);
  EXPECT_LT(some.result().evaluations, states);
  EXPECT_LE(some.result().von_mises, largest);
  EXPECT_GE(some.result().von_mises, largest_of_frames);
  const CellLocation place = location_of_cell(run.model().mesh, all.result().cell);
  EXPECT_GE(place.centre[0], 5.0);
  EXPECT_LE(place.centre[0], 15.0);
}

}  // namespace ricochet::test_support::impacts_test
