#include "ricochet/base/ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ricochet/simulation/history/history.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Results of a body distributed over processes.
namespace ricochet::test_support {
namespace {

/// Two ranks with identical halves.
class TwoAlike final : public Ranks {
 public:
  void reduce(std::span<double> values, std::span<const Reduction> by) const override {
    ASSERT_EQ(values.size(), by.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= by[i] == Reduction::sum ? 2.0 : 1.0;
  }
  /// The other rank owns everything.
  [[nodiscard]] bool is_owned(Index) const override { return false; }
};

TEST(Ranks, OneAloneChangesNothing) {
  std::vector<double> values{1.0, -2.0};
  const std::vector<Reduction> by{Reduction::sum, Reduction::maximum};
  one_rank().reduce(values, by);
  EXPECT_EQ(values, (std::vector<double>{1.0, -2.0}));
  EXPECT_EQ(one_rank().sum(3.0), 3.0);
  EXPECT_FALSE(one_rank().any(false));
  EXPECT_TRUE(one_rank().any(true));
  EXPECT_TRUE(one_rank().is_owned(0));
}

/// Energies, works, forces, momenta and counts are summed, largest values are not; the step, the time and the
/// iterations are equal on all ranks.
TEST(Ranks, EveryColumnOfTheHistorySaysHowItIsReduced) {
  CaseRun run(thrown_case(one_sided_block(), "equivalent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n",
                          "friction = 0.3\n"));
  for (int step = 0; step < 60; ++step) run.simulation().advance();
  SemidiscreteProblem divided = run.problem();
  const TwoAlike two;
  divided.ranks = &two;
  // Half of the whole body: cells and facets of the groups over which averages are formed.
  const std::vector<Group>& groups = run.model().mesh.groups;
  const Group& body = *std::ranges::find_if(groups, [](const Group& group) { return group.dimension == 2; });
  const auto sensors = [&](const SemidiscreteProblem& problem) {
    std::vector<std::shared_ptr<Sensor>> made;
    made.push_back(make_contact_sensor("c", problem, {SensedPair{0}}));
    made.push_back(make_cell_group_sensor("g", run.model().body, body.members, *problem.ranks));
    made.push_back(make_point_sensor(problem, {"p", 0, 0.0, -1}));
    return made;
  };
  HistoryRecorder alone(run.problem(), *run.model().rotation, sensors(run.problem()));
  HistoryRecorder both(divided, *run.model().rotation, sensors(divided));
  const std::vector<double> parts = alone.row(run.state(), run.simulation().account());
  const std::vector<double> whole = both.row(run.state(), run.simulation().account());
  double largest = 0.0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string& name = alone.columns()[i];
    const bool is_same = name == "step" || name == "time" || name == "iterations" || name.starts_with("max_") ||
                         name.starts_with("c.centre") || name.starts_with("g.");
    const double factor = name.starts_with("p.") ? 0.0 : is_same ? 1.0 : 2.0;
    EXPECT_DOUBLE_EQ(whole[i], factor * parts[i]) << name;
    largest = std::max(largest, std::abs(parts[i]));
  }
  EXPECT_GT(largest, 0.0);
}

}  // namespace
}  // namespace ricochet::test_support
