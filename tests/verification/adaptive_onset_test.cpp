#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/log.hpp"
#include "ricochet/simulation/step_control.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"
#include "support/thrown_body.hpp"

// Adaptive steps of bodies set in motion from rest by supports, loads and obstacles.

namespace ricochet::test_support::adaptive_onset_test {

/// A block of 35 nodes, at rest until it is set in motion; units of length, mass and time are powers of two.
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
  const std::string mesh = mesh_geometry(
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

/// Course of a run: kinetic and elastic energy over time.
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
    // A dof of an unsupported node.
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

/// Returns the distance between two displacements of the corner over time, relative to the largest.
double distance(const Course& one, const Course& reference) {
  double worst = 0.0, size = 0.0;
  for (std::size_t i = 0; i < reference.time.size(); ++i) {
    size = std::max(size, std::abs(reference.corner[i]));
    const auto after = std::size_t(std::ranges::lower_bound(one.time, reference.time[i]) - one.time.begin());
    if (after == 0 || after >= one.time.size()) continue;
    const double part = (reference.time[i] - one.time[after - 1]) / (one.time[after] - one.time[after - 1]);
    const double here = (1.0 - part) * one.corner[after - 1] + part * one.corner[after];
    worst = std::max(worst, std::abs(here - reference.corner[i]));
  }
  return worst / size;
}

/// Relative to the energy of the first instants no step is short enough; relative to the coming motion a few are.
TEST(AdaptiveOnset, SetOffFromRest) {
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
TEST(AdaptiveOnset, SetOffFromRestInAnyUnits) {
  for (const char* const kind : {"support", "pressure", "obstacle"}) {
    const Course one = course(onset(kind), {}), other = course(onset(kind, 1024.0, 0.25, 64.0), {});
    ASSERT_EQ(one.time.size(), other.time.size()) << kind;
    for (std::size_t i = 0; i < one.time.size(); ++i) ASSERT_EQ(64.0 * one.time[i], other.time[i]) << kind << ' ' << i;
  }
}

/// A run that is stopped within the prospect, and resumed.
TEST(AdaptiveOnset, SetOffFromRestWithTheSameBits) {
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

/// A velocity that jumps in every step has the same error for every length: the run reports this and ends in time.
TEST(AdaptiveOnset, EndWhereTheyDoNotGetOn) {
  const CaseRun run(thrown_case(one_sided_block(), "consistent", time_of("midpoint")));
  StepControl control(run.problem(), {.end = 1.0, .largest = 0.1, .smallest = 1e-9, .tolerance = 1e-3});
  State still = run.state();
  still.velocity.setZero();
  control.start(still);
  State jumped = still;
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  long steps = 0;
  expect_error(ErrorKind::not_converged, {"100000 steps", "time.smallest = 0.00625", "time.tolerance", "history.csv"},
               [&] {
                 for (; steps < 2 * StepControl::most_steps; ++steps) {
                   jumped.velocity.setConstant(steps % 2 == 0 ? 1.0 : -1.0);
                   while (!control.accept(still, jumped, 1.0)) {
                     if (control.needs_trial_step()) control.set_energy_ahead(0, 1.0);
                   }
                   control.watch(1.0, 0.0);
                 }
               });
  EXPECT_EQ(steps + 1, StepControl::most_steps);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(has(warnings[0], "the last 10000 steps"));
  // The advice in the message lets the run finish.
  StepControl other(run.problem(), {.end = 1.0, .largest = 0.1, .smallest = 0.00625, .tolerance = 1e-3});
  other.start(still);
  for (steps = 0; !other.at_end(); ++steps) {
    jumped.velocity.setConstant(steps % 2 == 0 ? 1.0 : -1.0);
    while (!other.accept(still, jumped, 1.0)) {
      if (other.needs_trial_step()) other.set_energy_ahead(0, 1.0);
    }
    other.watch(1.0, 0.0);
  }
  EXPECT_LE(steps, 160);
  // So does a tolerance that the jumps satisfy; with a shorter longest step, none has so many short steps.
  const auto steps_to = [&](const StepControlOptions& options) {
    StepControl control(run.problem(), options);
    control.start(still);
    long count = 0;
    for (; !control.at_end(); ++count) {
      jumped.velocity.setConstant(count % 2 == 0 ? 1.0 : -1.0);
      while (!control.accept(still, jumped, 1.0)) {
        if (control.needs_trial_step()) control.set_energy_ahead(0, 1.0);
      }
      control.watch(1.0, 0.0);
    }
    return count;
  };
  EXPECT_LE(steps_to({.end = 1.0, .largest = 0.1, .smallest = 1e-9, .tolerance = 10.0}), 160);
  EXPECT_GE(steps_to({.end = 1.0, .largest = 1e-4, .smallest = 1e-5, .tolerance = 1e-3}), 10000);
  EXPECT_EQ(warnings.size(), 1u);
}

}  // namespace ricochet::test_support::adaptive_onset_test
