#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "ricochet/simulation/step_control.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"
#include "support/paths.hpp"
#include "support/thrown_body.hpp"

// Steps with a length that follows the motion.

namespace ricochet::test_support::adaptive_steps_test {

const std::vector<std::string> adaptive = {"time.step=adaptive", "time.largest=0.1", "time.tolerance=0.001"};

TEST(AdaptiveSteps, TimeHasNoDriftInAMillionSteps) {
  const CaseRun run(thrown_case(one_sided_block(), "consistent", time_of("midpoint")));
  const double largest = 0.1;  // no binary fraction
  StepControl control(run.problem(), {.end = 1e9, .largest = largest, .smallest = largest / 1024, .tolerance = 1e-3});
  State still = run.state();
  still.velocity.setZero();
  control.start(still);
  // The step length changes continually: a jump of the velocity shortens the steps, rest lets them grow.
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
    // The lengths are whole multiples of the smallest one, to the last bit.
    const double smallest = std::ldexp(largest, -10);
    ASSERT_EQ(control.time(), std::round(control.time() / smallest) * smallest);
  }
  EXPECT_EQ(longest, largest);
  EXPECT_LT(shortest, 0.3 * largest);
  EXPECT_NEAR(control.time(), sum, 1e-9 * sum);
}

/// A scheme whose contact creates more energy with shorter steps, which therefore become shorter still.
TEST(AdaptiveSteps, StopWhereTheSchemeHasMadeMostOfTheEnergy) {
  CaseRun run(thrown_case(thrown_bodies()[0], "consistent", time_of("midpoint")),
              {adaptive[0], adaptive[1], adaptive[2], "time.end=20"});
  expect_error(ErrorKind::not_converged, {"the time scheme has created"}, [&] { run.run([] {}); });
  EXPECT_LT(run.state().time, 20.0);
  EXPECT_TRUE(run.state().velocity.allFinite());
}

TEST(AdaptiveSteps, EndAtTheEnd) {
  for (const double end : {1.5, 1.0001, 0.9}) {
    CaseRun run(thrown_case(thrown_bodies()[0], "equivalent", time_of("reduced-kane")),
                {adaptive[0], adaptive[1], adaptive[2], "time.smallest=1e-4", "time.end=" + std::to_string(end)});
    run.run([] {});
    EXPECT_GE(run.state().time, end * (1.0 - 1e-12));
    EXPECT_LT(run.state().time, end + run.simulation().control()->counts().shortest);
    EXPECT_TRUE(run.session().at_end());
  }
}

/// A step without a solution is repeated with a shorter length, also near the end; one that blows up is refused, and
/// the error measure is unchanged.
TEST(AdaptiveSteps, AttemptsThatFailLeaveNothingBehind) {
  const CaseRun run(thrown_case(one_sided_block(), "consistent", time_of("midpoint")));
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

/// The accounts of energy and momentum continue over changed and repeated steps, with friction, a moving obstacle,
/// varying loads and damping.
TEST(AdaptiveSteps, AccountsCloseUnderEveryScheme) {
  int schemes = 0;
  for (const std::string& scheme : scheme_names()) {
    const std::string mass = masses_of(scheme)[0];
    const std::string text =
        dragged_case(thrown_bodies()[0], mass, time_of(scheme), takes_friction(scheme) ? "friction = 0.3\n" : "");
    try {
      std::vector<std::string> changes = adaptive;
      // Short steps in contact multiply its energy without bound, a property of the scheme.
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
      EXPECT_TRUE(has(refusal.what(), "uses the previous step"));
      EXPECT_TRUE(has(refusal.what(), "time.step"));
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
  Session session(source_path("cases/ball/ball.toml"), changes);
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

/// Relative error of the height over time, in the L² norm.
double error(const Bounces& run, const Bounces& reference) {
  const auto at = [](const Bounces& each, double time) {
    const auto after = std::size_t(std::ranges::lower_bound(each.time, time) - each.time.begin());
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

/// The error of fixed steps decreases with their length; reaching the adaptive run's error would take more than twice
/// as many fixed steps as its steps, refused ones included.
TEST(AdaptiveSteps, ReachAGivenErrorWithHalfTheWorkOfFixedSteps) {
  const Bounces reference = bounces(ball({"time.step=2e-5"}));
  const Bounces adapted = bounces(ball({"time.step=adaptive", "time.largest=0.01", "time.tolerance=1e-3"}));
  const double reached = error(adapted, reference);
  EXPECT_LT(reached, 0.08);
  double least = 1e300;  // fixed steps needed for this error, between two runs
  double error_before = 0.0, steps_before = 0.0;
  for (const char* const step : {"time.step=8e-4", "time.step=4e-4", "time.step=2e-4", "time.step=1e-4"}) {
    const Bounces fixed = bounces(ball({step}));
    const double own = error(fixed, reference);
    const auto steps = double(fixed.solves);
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
  EXPECT_LT(2.0 * double(adapted.solves), least) << "error " << reached;
  // The first contact is resolved: free fall from 5 mm takes √(2H/g).
  EXPECT_NEAR(adapted.first_touch, std::sqrt(2.0 * 0.005 / 9.81), 1.5e-3);
  EXPECT_LT(adapted.step_there, 2e-3);
}

}  // namespace ricochet::test_support::adaptive_steps_test
