#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/simulation/momentum_account.hpp"
#include "ricochet/simulation/step_control.hpp"
#include "support/case_run.hpp"
#include "support/paths.hpp"
#include "support/thrown_body.hpp"

// Steps whose length follows the motion.

namespace ricochet {
namespace adaptive_steps_test {

using test_support::CaseRun;
using test_support::dragged_case;
using test_support::masses_of;
using test_support::takes_friction;
using test_support::thrown_bodies;
using test_support::time_of;

const std::vector<std::string> adaptive = {"time.step=adaptive", "time.largest=0.1", "time.tolerance=0.001"};

TEST(AdaptiveSteps, TimeHasNoDriftInAMillionSteps) {
  const CaseRun run(test_support::thrown_case(test_support::one_sided_block(), "consistent", time_of("midpoint")));
  const double largest = 0.1;  // no binary fraction
  StepControl control(run.problem(), {.end = 1e9, .largest = largest, .smallest = largest / 1024, .tolerance = 1e-3});
  State still = run.state();
  still.velocity.setZero();
  control.start(still);
  // Lengths change all the time: a jump of the velocity shortens steps, rest lets them grow.
  State jumped = still;
  long steps = 0;
  double sum = 0.0, longest = 0.0, shortest = largest;
  for (long attempt = 0; steps < 1'000'000; ++attempt) {
    jumped.velocity.setConstant(attempt % 100 == 0 ? 1.0 : 0.0);
    const double length = control.step();
    if (!control.accept(still, jumped, 1.0)) continue;
    ++steps;
    sum += length;
    longest = std::max(longest, length);
    shortest = std::min(shortest, length);
    // A whole number of the smallest lengths, to the last bit.
    const double smallest = std::ldexp(largest, -10);
    ASSERT_EQ(control.time(), std::round(control.time() / smallest) * smallest);
  }
  EXPECT_EQ(longest, largest);
  EXPECT_LT(shortest, 0.3 * largest);
  EXPECT_NEAR(control.time(), sum, 1e-9 * sum);
}

/// Under a scheme whose contact creates the more energy the shorter the steps, which then become shorter still.
TEST(AdaptiveSteps, StopWhereTheSchemeHasMadeMostOfTheEnergy) {
  CaseRun run(test_support::thrown_case(thrown_bodies()[0], "consistent", time_of("midpoint")),
              {adaptive[0], adaptive[1], adaptive[2], "time.end=20"});
  try {
    run.run([] {});
    FAIL() << "no error";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.kind(), ErrorKind::not_converged);
    EXPECT_NE(std::string(problem.what()).find("the time scheme has created"), std::string::npos) << problem.what();
  }
  EXPECT_LT(run.state().time, 20.0);
  EXPECT_TRUE(run.state().velocity.allFinite());
}

TEST(AdaptiveSteps, EndAtTheEnd) {
  for (const double end : {1.5, 1.0001, 0.9}) {
    CaseRun run(test_support::thrown_case(thrown_bodies()[0], "equivalent", time_of("reduced-kane")),
                {adaptive[0], adaptive[1], adaptive[2], "time.smallest=1e-4", "time.end=" + std::to_string(end)});
    run.run([] {});
    EXPECT_GE(run.state().time, end * (1.0 - 1e-12));
    EXPECT_LT(run.state().time, end + run.simulation().control()->counts().shortest);
    EXPECT_TRUE(run.session().at_end());
  }
}

/// A step that finds no solution is followed by a shorter one, near the end too; one that blows up by refusals that
/// leave the measure of errors as it was.
TEST(AdaptiveSteps, AttemptsThatFailLeaveNothingBehind) {
  const CaseRun run(test_support::thrown_case(test_support::one_sided_block(), "consistent", time_of("midpoint")));
  StepControl control(run.problem(), {.end = 0.33, .largest = 0.1, .smallest = 1e-9, .tolerance = 1e-3});
  State still = run.state();
  still.velocity.setZero();
  control.start(still);
  while (control.time() < 0.3) ASSERT_TRUE(control.accept(still, still, 1.0));
  const double before = control.step();
  ASSERT_TRUE(control.shorten());
  EXPECT_EQ(control.step(), 0.5 * before);
  EXPECT_EQ(control.counts().unsolved, 1);
  State jumped = still;
  jumped.velocity.setConstant(1e3);
  EXPECT_FALSE(control.accept(still, jumped, 1e300));
  jumped.velocity.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(control.accept(still, jumped, 1.0));
  EXPECT_EQ(control.counts().refused, 2);
  while (!control.at_end()) ASSERT_TRUE(control.accept(still, still, 1.0));
  EXPECT_LT(control.time(), 0.33 + control.counts().shortest);
}

/// The accounts of energy and momentum go on over changes of the step and steps that are taken again, with friction, a
/// moving obstacle, loads that vary and damping.
TEST(AdaptiveSteps, AccountsCloseUnderEveryScheme) {
  int schemes = 0;
  for (const std::string& scheme : scheme_names()) {
    const std::string mass = masses_of(scheme)[0];
    const std::string text =
        dragged_case(thrown_bodies()[0], mass, time_of(scheme), takes_friction(scheme) ? "friction = 0.3\n" : "");
    try {
      std::vector<std::string> changes = adaptive;
      // Short steps at contact multiply its energy without bound: that is the scheme.
      if (scheme == "midpoint") changes.insert(changes.end(), {"time.end=0.04", "time.tolerance=0.01"});
      CaseRun run(text, changes);
      ++schemes;
      MomentumAccount momentum(run.problem(), run.scheme(), run.state());
      const auto impulse_of = [&](const State& state) {
        Vector flow;
        run.problem().mass.multiply(state.velocity, flow);
        Eigen::Vector2d sum(0.0, 0.0);
        for (Index i = 0; i < flow.size(); ++i) sum[i % 2] += flow[i];
        return sum;
      };
      const Eigen::Vector2d start = impulse_of(run.state());
      double largest = 0.0, worst = 0.0, drift = 0.0;
      run.run(
          [&] {
            const Energies now = run.simulation().account().energies(run.state());
            largest = std::max({largest, now.kinetic, now.elastic, std::abs(now.total())});
            worst = std::max(worst, std::abs(run.simulation().account().residual(now)));
            momentum.enter_step(run.state());
            drift = std::max(drift, (impulse_of(run.state()) - start - momentum.impulse().force.head<2>()).norm());
          },
          false);
      EXPECT_LT(worst, 1e-12 * largest) << scheme;
      EXPECT_LT(drift, 1e-12 * momentum.size()) << scheme;
      const StepCounts& counts = run.simulation().control()->counts();
      EXPECT_GT(counts.refused, 0) << scheme;
      EXPECT_GT(counts.longest, counts.shortest) << scheme;
      EXPECT_EQ(counts.unsolved, 0) << scheme;
    } catch (const Error& refusal) {
      EXPECT_NE(std::string(refusal.what()).find("remembers the step before"), std::string::npos) << refusal.what();
      EXPECT_NE(std::string(refusal.what()).find("time.step"), std::string::npos) << refusal.what();
    }
  }
  EXPECT_GE(schemes, 14);
}

/// A rubber ball with some damping falls 5 mm, bounces and falls again: cases/ball.
std::vector<std::string> ball(std::initializer_list<const char*> more) {
  std::vector<std::string> result = {"material.0.damping.stiffness=2e-5"};
  result.insert(result.end(), more.begin(), more.end());
  return result;
}

struct Bounces {
  std::vector<double> time, height;
  long solves = 0;
  double first_touch = -1.0, step_there = 0.0;
};
Bounces bounces(const std::vector<std::string>& changes) {
  Session session(test_support::source_path("cases/ball/ball.toml"), changes);
  session.start();
  Bounces result;
  const Index top = session.problem().dof_count() - 1;
  double before = 0.0;
  session.run([&] {
    const State& state = session.state();
    result.time.push_back(state.time);
    result.height.push_back(state.displacement[top]);
    if (result.first_touch < 0.0 && state.forces.normal_reaction.sum() > 0.0) {
      result.first_touch = before;
      result.step_there = state.time - before;
    }
    before = state.time;
  });
  const StepControl* const control = session.simulation().control();
  result.solves = session.state().step + (control != nullptr ? control->counts().refused : 0);
  return result;
}

/// Of the height over time, in the L² norm.
double error(const Bounces& run, const Bounces& reference) {
  const auto at = [](const Bounces& each, double time) {
    const auto after =
        static_cast<std::size_t>(std::lower_bound(each.time.begin(), each.time.end(), time) - each.time.begin());
    if (after == 0 || after >= each.time.size()) return each.height[std::min(after, each.height.size() - 1)];
    const double part = (time - each.time[after - 1]) / (each.time[after] - each.time[after - 1]);
    return (1.0 - part) * each.height[after - 1] + part * each.height[after];
  };
  double sum = 0.0, size = 0.0;
  for (double time = 0.01; time < 0.159; time += 1e-4) {
    sum += std::pow(at(run, time) - at(reference, time), 2);
    size += std::pow(at(reference, time), 2);
  }
  return std::sqrt(sum / size);
}

/// The error of fixed steps falls with their length; those that reach the adaptive run's error would be more than
/// twice as many as its steps, refused ones included.
TEST(AdaptiveSteps, ReachAGivenErrorWithHalfTheWorkOfFixedSteps) {
  const Bounces reference = bounces(ball({"time.step=2e-5"}));
  const Bounces adapted = bounces(ball({"time.step=adaptive", "time.largest=0.01", "time.tolerance=1e-3"}));
  const double reached = error(adapted, reference);
  EXPECT_LT(reached, 0.08);
  double least = 1e300;  // steps that fixed ones need for this error, between two runs
  double error_before = 0.0, steps_before = 0.0;
  for (const char* const step : {"time.step=8e-4", "time.step=4e-4", "time.step=2e-4", "time.step=1e-4"}) {
    const Bounces fixed = bounces(ball({step}));
    const double own = error(fixed, reference);
    const auto steps = static_cast<double>(fixed.solves);
    if (own <= reached) {
      least = steps;
      if (error_before > reached)
        least = steps_before *
                std::pow(steps / steps_before, std::log(reached / error_before) / std::log(own / error_before));
      break;
    }
    error_before = own;
    steps_before = steps;
  }
  EXPECT_LT(2.0 * static_cast<double>(adapted.solves), least) << "error " << reached;
  // The first touch is met: free fall of 5 mm takes √(2H/g).
  EXPECT_NEAR(adapted.first_touch, std::sqrt(2.0 * 0.005 / 9.81), 1.5e-3);
  EXPECT_LT(adapted.step_there, 2e-3);
}

/// A block of 35 nodes that is at rest until something sets it off; units of length, mass and time are powers of two.
std::string onset(const std::string& kind, double length = 1.0, double mass = 1.0, double time = 1.0) {
  const double stress = mass / length / time / time;
  const auto expression = [&](double factor, const std::string& in_t) {
    return fmt::format("\"{:.17g}*({})\"", factor, in_t);
  };
  const std::string t = fmt::format("t*{:.17g}", 1.0 / time);
  const auto push = [&](const char* section, const std::string& group, const std::string& value) {
    return fmt::format("[[{}]]\ngroup = \"{}\"\nvalue = {}\n", section, group, value);
  };
  const std::string support = "[[support]]\ngroup = \"left\"\ncomponents = [\"x\", \"y\"]\nvalue = ";
  std::string held = support + "0\n", floor = fmt::format("point = [0, {:.17g}]\n", -10.0 * length), more;
  if (kind == "support") held = support + expression(0.01 * length, "1-cos(6*" + t + ")") + "\n";
  if (kind == "late support") held = support + expression(0.01 * length, "1-cos(6*max(" + t + "-0.0731,0))") + "\n";
  if (kind == "traction")
    more = push("traction", "right", "[\"0\", " + expression(-1000.0 * stress, "min(" + t + "/0.1,1)") + "]");
  if (kind == "pressure") more = push("pressure", "top", expression(1000.0 * stress, t));
  if (kind == "gravity") more = fmt::format("[load]\ngravity = [0, {:.17g}]\n", -9.81 * length / time / time);
  if (kind == "obstacle")
    floor = fmt::format("point = [0, {:.17g}]\nmotion = [\"0\", {}]\n", -0.003 * length, expression(0.05 * length, t));
  const std::string mesh = test_support::mesh_geometry(
      fmt::format("onset{:g}.geo", length),
      fmt::format("Rectangle(1) = {{0, 0, 0, {0:.17g}, {1:.17g}}};\n"
                  "Transfinite Curve{{1,3}} = 7; Transfinite Curve{{2,4}} = 5; Transfinite Surface{{1}};\n"
                  "Physical Surface(\"body\") = {{1}}; Physical Curve(\"bottom\") = {{1}}; Physical Curve(\"right\") = "
                  "{{2}};\nPhysical Curve(\"top\") = {{3}}; Physical Curve(\"left\") = {{4}};\n",
                  0.625 * length, 0.375 * length),
      length, 1);
  return fmt::format(
      "[mesh]\nfile = \"{}\"\nplane = \"strain\"\n[[material]]\ngroup = \"body\"\ndensity = {:.17g}\nyoung = "
      "{:.17g}\npoisson = 0.3\n{}{}[obstacle.floor]\ntype = \"plane\"\nnormal = [0, 1]\n{}[[contact]]\ngroup = "
      "\"bottom\"\nobstacle = \"floor\"\n[time]\nstep = \"adaptive\"\nlargest = {:.17g}\nend = {:.17g}\n",
      mesh, 1000.0 * mass / length / length / length, 1e6 * stress, held, more, floor, 0.0078125 * time, 0.25 * time);
}

const std::vector<std::string> onsets = {"support", "late support", "traction", "pressure", "gravity", "obstacle"};

/// What a run of an onset comes to: the way that kinetic and elastic energy go.
struct Course {
  std::vector<double> time, energy, corner;
  long attempts = 0, tolerated = 0;
};
Course course(const std::string& text, const std::vector<std::string>& changes) {
  CaseRun run(text, changes);
  Course result;
  run.run([&] {
    const Energies now = run.simulation().account().energies(run.state());
    result.time.push_back(run.state().time);
    result.energy.push_back(now.kinetic + now.elastic);
    // Of a node that no support holds.
    Index free = run.problem().dof_count() - 1;
    while (run.problem().supports.contains(free)) --free;
    result.corner.push_back(run.state().displacement[free]);
    ASSERT_LT(result.time.size(), 5000u) << "steps do not get on";
  });
  const StepControl* const control = run.simulation().control();
  result.attempts = run.state().step;
  if (control != nullptr) {
    result.attempts += control->counts().refused;
    result.tolerated = control->counts().tolerated;
  }
  return result;
}

/// Of the corner's displacement over time, relative to its largest.
double distance(const Course& one, const Course& reference) {
  double worst = 0.0, size = 0.0;
  for (std::size_t i = 0; i < reference.time.size(); ++i) {
    size = std::max(size, std::abs(reference.corner[i]));
    const auto after = static_cast<std::size_t>(std::lower_bound(one.time.begin(), one.time.end(), reference.time[i]) -
                                                one.time.begin());
    if (after == 0 || after >= one.time.size()) continue;
    const double part = (reference.time[i] - one.time[after - 1]) / (one.time[after] - one.time[after - 1]);
    const double here = (1.0 - part) * one.corner[after - 1] + part * one.corner[after];
    worst = std::max(worst, std::abs(here - reference.corner[i]));
  }
  return worst / size;
}

/// Beside the energy of the first instants no step is short enough; beside what is about to come a few are.
TEST(AdaptiveSteps, SetOffFromRest) {
  for (const std::string& kind : onsets) {
    const std::string text = onset(kind);
    const Course reference = course(text, {"time.step=1e-4", "output.fields_every=0"});
    double before = 1.0;
    long attempts_before = 0;
    for (const double tolerance : {4e-3, 1e-3, 2.5e-4}) {
      const Course found = course(text, {fmt::format("time.tolerance={}", tolerance)});
      EXPECT_LT(found.attempts, 1200) << kind << ", tolerance " << tolerance;
      EXPECT_EQ(found.tolerated, 0) << kind << ", tolerance " << tolerance;
      const double error = distance(found, reference);
      EXPECT_LT(error, 1.05 * before) << kind << ", tolerance " << tolerance;
      EXPECT_GE(found.attempts, attempts_before) << kind;
      before = error;
      attempts_before = found.attempts;
    }
    EXPECT_LT(before, 0.02) << kind;
  }
}

/// Another unit of length, mass or time gives the same steps.
TEST(AdaptiveSteps, SetOffFromRestInAnyUnits) {
  for (const char* const kind : {"support", "pressure", "obstacle"}) {
    const Course one = course(onset(kind), {}), other = course(onset(kind, 1024.0, 0.25, 64.0), {});
    ASSERT_EQ(one.time.size(), other.time.size()) << kind;
    for (std::size_t i = 0; i < one.time.size(); ++i) ASSERT_EQ(64.0 * one.time[i], other.time[i]) << kind << ' ' << i;
  }
}

/// A run that is stopped and goes on within the look ahead.
TEST(AdaptiveSteps, SetOffFromRestWithTheSameBits) {
  for (const std::string& kind : onsets) {
    CaseRun whole(onset(kind));
    std::vector<Snapshot> saved;
    whole.run([&] {
      if (whole.state().step % 11 == 3 && saved.size() < 6) whole.session().save(saved.emplace_back());
    });
    for (const Snapshot& snapshot : saved) {
      Session again(whole.input());
      again.resume(snapshot);
      again.run([] {});
      ASSERT_EQ(again.state().step, whole.state().step) << kind;
      ASSERT_EQ(again.state().displacement, whole.state().displacement) << kind;
    }
  }
}

/// A velocity that jumps in every step has the same error at any length: that is told, and ends in time.
TEST(AdaptiveSteps, EndWhereTheyDoNotGetOn) {
  const CaseRun run(test_support::thrown_case(test_support::one_sided_block(), "consistent", time_of("midpoint")));
  StepControl control(run.problem(), {.end = 1.0, .largest = 0.1, .smallest = 1e-9, .tolerance = 1e-3});
  State still = run.state();
  still.velocity.setZero();
  control.start(still);
  State jumped = still;
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  long steps = 0;
  try {
    for (; steps < 2 * StepControl::most_steps; ++steps) {
      jumped.velocity.setConstant(steps % 2 == 0 ? 1.0 : -1.0);
      while (!control.accept(still, jumped, 1.0)) {
        if (control.wants_prospect()) control.take_prospect(0, 1.0);
      }
      control.watch(1.0, 0.0);
    }
    FAIL() << "no error";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.kind(), ErrorKind::not_converged);
    for (const char* const said : {"100000 steps", "time.smallest = 0.00625", "time.tolerance", "history.csv"})
      EXPECT_NE(std::string(problem.what()).find(said), std::string::npos) << problem.what();
  }
  EXPECT_EQ(steps + 1, StepControl::most_steps);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("the last 10000 steps"), std::string::npos) << warnings[0];
  // What it advises ends the run.
  StepControl other(run.problem(), {.end = 1.0, .largest = 0.1, .smallest = 0.00625, .tolerance = 1e-3});
  other.start(still);
  for (steps = 0; !other.at_end(); ++steps) {
    jumped.velocity.setConstant(steps % 2 == 0 ? 1.0 : -1.0);
    while (!other.accept(still, jumped, 1.0)) {
      if (other.wants_prospect()) other.take_prospect(0, 1.0);
    }
    other.watch(1.0, 0.0);
  }
  EXPECT_LE(steps, 160);
}

}  // namespace adaptive_steps_test
}  // namespace ricochet
