#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/simulation/simulation.hpp"
#include "support/case_run.hpp"

/// @file Lengths of the attempts at steps that have no solution as a whole.
namespace ricochet::test_support::cut_steps_test {

constexpr double whole_step = 0.25;  // halves of it are exact

struct Attempt {
  double time, length;
  bool is_solved;
  bool operator==(const Attempt&) const = default;
};

using Condition = std::function<bool(double time, double length)>;

/// Lengths up to a limit that depends on the time.
Condition up_to(std::function<double(double time)> limit) {
  return [limit = std::move(limit)](double time, double length) { return length <= limit(time); };
}

/// A body at rest whose steps have solutions under a condition.
class Stubborn final : public Scheme {
 public:
  explicit Stubborn(Condition condition)
      : Scheme(whole_step, {.supports_step_changes = true, .supports_nonlinear_force = true}),
        condition_(std::move(condition)) {}
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    return {{.mass = 1.0, .stiffness = 1.0, .damping = 0.0}};
  }
  void advance(const SemidiscreteProblem& problem, State& state, StageSolve&, Vector& increment) override {
    const bool is_solved = condition_(state.time, step());
    attempts.push_back({state.time, step(), is_solved});
    if (!is_solved) throw Error(ErrorKind::not_converged, "there is no solution");
    increment.setZero(problem.dof_count());
  }
  std::vector<Attempt> attempts;

 private:
  Condition condition_;
};

class CutSteps : public testing::Test {
 protected:
  CutSteps()
      : run_(
            "[mesh]\nfile = \"" +
            mesh_geometry("cut-steps", "Rectangle(1) = {0, 0, 0, 1, 1};\nPhysical Surface(\"body\") = {1};\n", 1.0, 1) +
            "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 1.0\npoisson = 0.3\nlaw = \"neo-hookean\"\n"
            "[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 0.25\nend = 25.0\n") {}
  [[nodiscard]] Simulation start(Scheme& scheme) { return {run_.problem(), scheme, run_.model().initial}; }

  CaseRun run_;
};

long failures(const std::vector<Attempt>& attempts) { return std::ranges::count(attempts, false, &Attempt::is_solved); }

TEST_F(CutSteps, BeginWithTheLengthThatTheLastOneNeeded) {
  Stubborn scheme(up_to([](double) { return whole_step / 8.0; }));
  Simulation simulation = start(scheme);
  for (int k = 0; k < 40; ++k) simulation.advance();
  EXPECT_EQ(simulation.cut_steps(), 40);
  EXPECT_EQ(simulation.state().time, 40 * whole_step);
  // One part of twice the length is tried for 16 of the 320 parts at last, and three times before. Three lengths fail
  // in the first step, the first of them twice.
  EXPECT_LE(failures(scheme.attempts), 320 / 16 + 3 + 4);
}

TEST_F(CutSteps, AreFollowedByWholeOnesAfterADifficulty) {
  Stubborn scheme(up_to([](double time) { return time < 10 * whole_step ? whole_step / 4.0 : whole_step; }));
  Simulation simulation = start(scheme);
  for (int k = 0; k < 20; ++k) simulation.advance();
  const long cut = simulation.cut_steps();
  scheme.attempts.clear();
  for (int k = 20; k < 25; ++k) simulation.advance();
  EXPECT_EQ(simulation.cut_steps(), cut);
  EXPECT_EQ(scheme.attempts.size(), 5);
}

/// Each part is passed to the caller at its time. Halves fail twice in the first step, where the second one is tried
/// after two quarters: the next one follows after the length of two halves since then.
TEST_F(CutSteps, ReportTheirPartsAtTheirTimes) {
  Stubborn scheme(up_to([](double time) { return time < whole_step ? whole_step / 4.0 : whole_step / 2.0; }));
  Simulation simulation = start(scheme);
  std::vector<double> times;
  for (int k = 0; k < 2; ++k) simulation.advance([&](const State& state) { times.push_back(state.time / whole_step); });
  EXPECT_EQ(times, (std::vector<double>{0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0}));
}

/// A length that has just failed with the tangent at the start of the part is attempted with that of the new start
/// alone, and so is the one that follows it. After a solution, operators are kept again.
TEST_F(CutSteps, AreAttemptedOnceWithALengthThatHasFailed) {
  Stubborn scheme(
      up_to([](double time) { return time == 3 * whole_step || time > 5 * whole_step ? 0.5 * whole_step : 1.0; }));
  Simulation simulation = start(scheme);
  for (int k = 0; k < 8; ++k) simulation.advance();
  const auto attempts_at = [&](double time, double length) {
    return std::ranges::count(scheme.attempts, Attempt{time, length, false});
  };
  EXPECT_EQ(attempts_at(3 * whole_step, whole_step), 2);
  EXPECT_EQ(attempts_at(6 * whole_step, whole_step), 2);
  EXPECT_EQ(attempts_at(7 * whole_step, whole_step), 1);
}

/// Parts of the remembered length may have no solution where longer ones have one, as when facets are paired in another
/// way: the step is then attempted whole.
TEST_F(CutSteps, AreAttemptedWholeIfShortPartsLeadNowhere) {
  Stubborn scheme(
      [](double time, double length) { return time < whole_step ? length <= whole_step / 8.0 : length == whole_step; });
  Simulation simulation = start(scheme);
  for (int k = 0; k < 3; ++k) simulation.advance();
  EXPECT_EQ(simulation.cut_steps(), 1);
  EXPECT_EQ(scheme.attempts.back(), (Attempt{2 * whole_step, whole_step, true}));
}

/// A caller who changes the state after a step without a solution can repeat the whole of it.
TEST_F(CutSteps, LeaveNoTraceIfTheyFail) {
  bool is_solvable = false;
  Stubborn scheme(up_to([&](double) { return is_solvable ? whole_step : 0.0; }));
  Simulation simulation = start(scheme);
  EXPECT_THROW(simulation.advance(), Error);
  is_solvable = true;
  scheme.attempts.clear();
  simulation.advance();
  EXPECT_EQ(scheme.attempts, (std::vector<Attempt>{{0.0, whole_step, true}}));
  EXPECT_EQ(simulation.cut_steps(), 0);
}

/// As a run that never stopped: lengths of attempts are part of its bits.
TEST_F(CutSteps, GoOnFromASnapshotWithTheSameLengths) {
  const Condition condition = up_to([](double time) { return time < 12 * whole_step ? whole_step / 8.0 : whole_step; });
  Stubborn scheme(condition), again(condition);
  Simulation simulation = start(scheme);
  for (int k = 0; k < 7; ++k) simulation.advance();
  Snapshot snapshot;
  simulation.save(snapshot);
  scheme.attempts.clear();
  for (int k = 7; k < 20; ++k) simulation.advance();
  Simulation resumed(run_.problem(), again, snapshot);
  for (int k = 7; k < 20; ++k) resumed.advance();
  EXPECT_EQ(again.attempts, scheme.attempts);
}

}  // namespace ricochet::test_support::cut_steps_test
