#include "ricochet/io/summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "ricochet/base/error.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/version.hpp"

namespace ricochet {
namespace {

class SummaryTest : public testing::Test {
 protected:
  [[nodiscard]] std::string path() const { return folder_.file("summary.json"); }
  [[nodiscard]] RunSummary read_back(RunSummary summary) const {
    summary.version = version;
    write_summary(path(), summary);
    return read_summary(path());
  }

  TemporaryFolder folder_{std::filesystem::temp_directory_path(), "ricochet-test"};
};

TEST_F(SummaryTest, ReadsHowStepsWereSolvedAndWritten) {
  RunSummary summary;
  summary.history_every = 7;
  summary.processor_seconds = 1.5;
  summary.peak_memory = 2.0e9;
  summary.solver = "iterative";
  summary.solver_reason = "requested by the case";
  const RunSummary back = read_back(summary);
  EXPECT_EQ(back.history_every, summary.history_every);
  EXPECT_EQ(back.processor_seconds, summary.processor_seconds);
  EXPECT_EQ(back.peak_memory, summary.peak_memory);
  EXPECT_EQ(back.solver, summary.solver);
  EXPECT_EQ(back.solver_reason, summary.solver_reason);
}

TEST_F(SummaryTest, KnowsTheInstantsOfColumns) {
  RunSummary summary;
  summary.step = 0.1;
  summary.energy_instant = 0.5;
  summary.force_instant = -0.25;
  for (const char* column : {"total_energy", "load_potential", "momentum_x", "momentum.ball_x", "angular_momentum_z"})
    EXPECT_EQ(summary.delay_of(column), 0.05) << column;
  for (const char* column : {"contact_force_y", "pair_force.0_x", "ball.contact_force_x", "tip.reaction_normal",
                             "line.7.pressure", "tip.nominal_pressure"})
    EXPECT_EQ(summary.delay_of(column), -0.025) << column;
  for (const char* column :
       {"tip.displacement_x", "line.7.gap", "pressure.velocity_y", "momentum2.velocity_y",
        "angular_momentum.velocity_y", "end.force_x", "end.moment_z", "end.support_x", "support_work", "max_rotation"})
    EXPECT_EQ(summary.delay_of(column), 0.0) << column;
}

/// A run that overflows between two rows of the history stops at the next row; its values may be infinite or NaN, for
/// which JSON has no numbers.
TEST_F(SummaryTest, ReadsWhatAnOverflowingRunHasWritten) {
  RunSummary summary;
  summary.penetration.found.push_back(
      {"floor", {"the body"}, INFINITY, INFINITY, 0.5, {-INFINITY, 2.0}, 0.25, {"top", "left"}});
  summary.penetration.found.back().through_groups = {"inside"};
  summary.penetration.rims.push_back({"bottom", "floor", 0.75, {1.0, NAN}, {"left"}});
  summary.penetration.self_penetration_checks = 17;
  summary.penetration.not_watched = {"this", "that"};
  summary.bodies.push_back({{}, 0.1});
  Impact impact;
  impact.body = 0;
  impact.begin = 0.25;
  impact.end = 0.5;
  impact.contact_time = 0.25;
  impact.largest_force = INFINITY;
  impact.largest_force_time = 0.375;
  impact.contact_points = 5;
  impact.all_contact_points = 9;
  impact.first_position = {1.5, -INFINITY};
  impact.before.velocity = {INFINITY, -INFINITY, 0.0};
  summary.impacts.push_back(impact);
  summary.peak_stress =
      PeakStressDescription{{INFINITY, 0.5, 3, 7, 2, 4, StressRaiser::support_edge}, {1.5, 2.5}, 8, "steel"};
  summary.probe_sums = {{"pull", "of supports"}, {"fit", "of contact 0"}};

  const RunSummary back = read_back(summary);
  ASSERT_EQ(back.penetration.found.size(), 1u);
  const UnwatchedPenetration& found = back.penetration.found[0];
  EXPECT_EQ(found.depth, INFINITY);
  EXPECT_EQ(found.relative_depth, INFINITY);
  EXPECT_EQ(found.time, 0.5);
  EXPECT_EQ(found.position, (std::vector<double>{-INFINITY, 2.0}));
  EXPECT_EQ(found.first_time, 0.25);
  EXPECT_EQ(found.groups, (std::vector<std::string>{"top", "left"}));
  EXPECT_EQ(found.through_groups, (std::vector<std::string>{"inside"}));
  EXPECT_FALSE(found.is_self_penetration());
  EXPECT_EQ(back.penetration.self_penetration_checks, 17);
  EXPECT_EQ(back.penetration.not_watched, (std::vector<std::string>{"this", "that"}));
  EXPECT_FALSE(back.penetration.is_complete());
  ASSERT_EQ(back.penetration.rims.size(), 1u);
  EXPECT_EQ(back.penetration.rims[0].time, 0.75);
  ASSERT_EQ(back.penetration.rims[0].position.size(), 2u);
  EXPECT_EQ(back.penetration.rims[0].position[0], 1.0);
  EXPECT_TRUE(std::isnan(back.penetration.rims[0].position[1]));
  ASSERT_EQ(back.impacts.size(), 1u);
  EXPECT_EQ(back.impacts[0].begin, 0.25);
  EXPECT_EQ(back.impacts[0].end, 0.5);
  EXPECT_EQ(back.impacts[0].contact_time, 0.25);
  EXPECT_EQ(back.impacts[0].largest_force, INFINITY);
  EXPECT_EQ(back.impacts[0].largest_force_time, 0.375);
  EXPECT_EQ(back.impacts[0].contact_points, 5);
  EXPECT_EQ(back.impacts[0].all_contact_points, 9);
  EXPECT_EQ(back.impacts[0].first_position, (std::vector<double>{1.5, -INFINITY}));
  EXPECT_EQ(back.impacts[0].before.velocity[1], -INFINITY);
  ASSERT_TRUE(back.peak_stress.has_value());
  EXPECT_EQ(back.peak_stress->peak.von_mises, INFINITY);
  EXPECT_EQ(back.peak_stress->position, (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(back.peak_stress->element, 8);
  EXPECT_EQ(back.peak_stress->peak.raised_by, StressRaiser::support_edge);
  EXPECT_EQ(back.probe_sums, summary.probe_sums);
}

TEST_F(SummaryTest, KeepsBothBodiesOfAnImpact) {
  RunSummary summary;
  summary.bodies.push_back({{}, 0.1, "body \"one\""});
  summary.bodies.push_back({{}, 0.2, "body \"two\""});
  summary.bodies[0].rigid.mass = 2.0;
  summary.bodies[1].rigid.mass = 3.0;
  summary.bodies[1].rigid.held = true;
  Impact impact;
  impact.mass = 2.0;
  impact.before.velocity = {1.0, 0.0, 0.0};
  impact.after.velocity = {-0.5, 0.0, 0.0};
  impact.impulse = impact.normal_impulse = {-3.0, 0.0, 0.0};
  impact.other = OtherBody{1, 3.0, {}, {}};
  impact.other->before = {{0.25, 0.5, 0.0}, {0.0, 0.0, 7.0}, 11.0, 10.0};
  impact.other->after = {{1.25, 0.5, 0.0}, {0.0, 0.0, 8.0}, 13.0, 12.0};
  impact.other->held = true;
  summary.impacts.push_back(impact);
  summary.impacts.push_back(impact);
  summary.impacts[1].other.reset();
  summary.impacts[1].obstacle = "floor";
  const RunSummary back = read_back(summary);
  ASSERT_EQ(back.impacts.size(), 2U);
  EXPECT_EQ(back.impacts[0].obstacle, "");
  ASSERT_TRUE(back.impacts[0].other.has_value());
  const OtherBody& other = *back.impacts[0].other;
  EXPECT_EQ(other.number, 1);
  EXPECT_EQ(other.mass, 3.0);
  EXPECT_TRUE(other.held);
  EXPECT_FALSE(back.impacts[0].held);
  EXPECT_EQ(other.before.velocity, impact.other->before.velocity);
  EXPECT_EQ(other.after.spin, impact.other->after.spin);
  EXPECT_EQ(other.after.kinetic_energy, 13.0);
  EXPECT_EQ(other.before.rigid_kinetic_energy, 10.0);
  EXPECT_EQ(back.impacts[0].normal_velocity_before(), impact.normal_velocity_before());
  EXPECT_EQ(back.impacts[1].obstacle, "floor");
  EXPECT_FALSE(back.impacts[1].other.has_value());
  summary.impacts[0].other->number = 2;
  EXPECT_THROW((void)read_back(summary), Error);
}

TEST_F(SummaryTest, KeepsHowBodiesFaceAndSlide) {
  RunSummary summary;
  summary.contacts.push_back(
      {"a", "b", "p1", 0.0, 0.0, {}, 0.0, true, false, PairingDescription{"b", "it is softer", 7}});
  summary.contacts[0].facing->covered = 0.5;
  summary.contacts[0].facing->largest_gap = 0.25;
  summary.contacts.push_back({"c", "floor", "nodal"});
  summary.contacts.push_back({"d", "e", "p1", 0.0, 0.0, {}, 0.0, true, true});
  summary.sliding.push_back({0, 0.25, 0.125, 1.5, {2.0, 3.0}, 0.75});
  summary.sliding.push_back({1, 0.0625, 0.125, 1.5, {2.0, 3.0}});
  summary.unsettled.push_back({2, 0.5, 7, 0.25, 0.75, -0.125, {4.0, 5.0}});
  EXPECT_FALSE(read_back(summary).velocity_corrections.has_value());
  summary.velocity_corrections.emplace();
  EXPECT_EQ(read_back(summary).velocity_corrections->first_time, INFINITY);
  summary.velocity_corrections = {5, 0.25, 0.5, 0.75};
  const RunSummary back = read_back(summary);
  EXPECT_EQ(back.velocity_corrections->steps, 5);
  EXPECT_EQ(back.velocity_corrections->first_time, 0.25);
  EXPECT_EQ(back.velocity_corrections->largest, 0.5);
  EXPECT_EQ(back.velocity_corrections->time, 0.75);
  ASSERT_EQ(back.unsettled.size(), 1U);
  EXPECT_EQ(back.unsettled[0].contact, 2);
  EXPECT_EQ(back.unsettled[0].share, 0.5);
  EXPECT_EQ(back.unsettled[0].steps, 7);
  EXPECT_EQ(back.unsettled[0].first_time, 0.25);
  EXPECT_EQ(back.unsettled[0].time, 0.75);
  EXPECT_EQ(back.unsettled[0].gap, -0.125);
  EXPECT_EQ(back.unsettled[0].position, (std::vector<double>{4.0, 5.0}));
  ASSERT_TRUE(back.contacts.at(0).facing.has_value());
  EXPECT_FALSE(back.contacts[0].tied);
  EXPECT_TRUE(back.contacts.at(2).tied);
  EXPECT_EQ(back.contacts[0].facing->multipliers_on, "b");
  EXPECT_EQ(back.contacts[0].facing->reason, "it is softer");
  EXPECT_EQ(back.contacts[0].facing->points, 7);
  EXPECT_EQ(back.contacts[0].facing->covered, 0.5);
  EXPECT_EQ(back.contacts[0].facing->largest_gap, 0.25);
  EXPECT_FALSE(back.contacts.at(1).facing.has_value());
  ASSERT_EQ(back.sliding.size(), 2U);
  EXPECT_TRUE(back.sliding[0].is_beyond());
  EXPECT_EQ(back.sliding[0].time_beyond, 0.75);
  EXPECT_EQ(back.sliding[0].position, (std::vector<double>{2.0, 3.0}));
  EXPECT_EQ(back.sliding[1].time_beyond, INFINITY);
}

TEST_F(SummaryTest, KnowsInWhichImpactsCellsHadTurnedTooFar) {
  RunSummary summary;
  EXPECT_TRUE(summary.small_strain_holds_in_impacts());
  summary.bodies.push_back({{}, 0.1, "body \"left\""});
  summary.impacts.resize(2);
  summary.columns = {"max_rotation"};
  summary.digests = {{0.0, 0.3, 0.0, 0.3, 0.3}};
  summary.rotation = RotationReport{0.1, 0.5, {0.0625, 0.1}};
  const RunSummary later = read_back(summary);
  EXPECT_EQ(later.bodies[0].name, "body \"left\"");
  EXPECT_EQ(later.rotation.time_beyond, 0.5);
  EXPECT_TRUE(later.small_strain_holds_in_impacts());
  summary.rotation.until_impact_end[1] = 0.125;
  EXPECT_TRUE(read_back(summary).small_strain_holds_in(0));
  EXPECT_FALSE(read_back(summary).small_strain_holds_in(1));
  EXPECT_FALSE(read_back(summary).small_strain_holds_in_impacts());
  summary.rotation.time_beyond = INFINITY;
  EXPECT_EQ(read_back(summary).rotation.time_beyond, INFINITY);
}

TEST_F(SummaryTest, KnowsWhichImpactTheTurnOfABodyHasChanged) {
  RunSummary summary;
  summary.bodies.push_back({{2.0}, 0.1});
  summary.impacts.resize(2);
  for (Impact& impact : summary.impacts) {
    impact.mass = 2.0;
    impact.before.velocity = {0.0, -1.0, 0.0};
    impact.after.velocity = {0.0, 1.0, 0.0};
    impact.impulse = impact.normal_impulse = {0.0, 4.0, 0.0};
  }
  summary.rotation = RotationReport{0.1, INFINITY, {0.05, 0.05}};
  summary.impacts[1].rotation_growth = 0.0078125;
  const RunSummary back = read_back(summary);
  EXPECT_EQ(back.impacts[1].rotation_growth, 0.0078125);
  EXPECT_TRUE(back.small_strain_holds_in(0));
  EXPECT_FALSE(back.small_strain_holds_in(1));
  EXPECT_FALSE(back.small_strain_holds_in_impacts());
  EXPECT_TRUE(back.cells_turn_little_in_impacts());
}

RunSummary summary_of_works() {
  RunSummary summary;
  summary.columns = {"total_energy", "contact_work", "numerical_dissipation", "friction_work"};
  summary.digests = {
      {8.0, 4.0, 4.0, 8.0, 4.0}, {0.0, -1.0, -1.0, 0.5, 2.0}, {0.0, 1.0, 0.0, 1.0, 1.0}, {0.0, -2.0, -2.0, 0.0, 2.0}};
  return summary;
}

TEST_F(SummaryTest, TellsWhatTheMethodDidToTheEnergy) {
  RunSummary summary = summary_of_works();
  summary.method_energy = MethodEnergy{0.375, 0.0625, -0.25};
  const RunSummary back = read_back(summary);
  EXPECT_EQ(back.method_energy.lost, 0.375);
  EXPECT_EQ(back.method_energy.created, 0.0625);
  EXPECT_EQ(back.method_energy.at_end, -0.25);
  const auto written = [text = to_json(summary)](const std::string& path) { return summary_value(text, path); };
  EXPECT_EQ(written("energy_budget.largest_energy"), 8.0);
  EXPECT_EQ(written("energy_budget.lost_by_method"), 0.375);
  EXPECT_EQ(written("energy_budget.at_end.method"), -0.25);
  EXPECT_EQ(written("energy_budget.at_end.friction"), -0.25);
  EXPECT_EQ(written("energy_budget.at_end.loads"), 0.0);
}

TEST_F(SummaryTest, TellsWhichReactionsActed) {
  RunSummary summary;
  summary.reactions = ActingReactions{"adaptive", 0.0, 0.375, 12, 3};
  const RunSummary back = read_back(summary);
  ASSERT_TRUE(back.reactions.has_value());
  EXPECT_EQ(back.reactions->kind, "adaptive");
  EXPECT_EQ(back.reactions->least_weight, 0.0);
  EXPECT_EQ(back.reactions->largest_weight, 0.375);
  EXPECT_EQ(back.reactions->mean_steps, 12);
  EXPECT_EQ(back.reactions->end_steps, 3);
  summary.reactions = ActingReactions{.kind = "end"};
  const RunSummary end = read_back(summary);
  EXPECT_EQ(end.reactions->kind, "end");
  EXPECT_GT(end.reactions->least_weight, end.reactions->largest_weight) << "no mean acted";
}

TEST_F(SummaryTest, KeepsWhatTheMethodDidInAnImpact) {
  RunSummary summary;
  summary.bodies.push_back({{}, 0.1});
  summary.impacts.resize(2);
  summary.impacts[0].method_energy = -0.125;
  const RunSummary back = read_back(summary);
  EXPECT_EQ(back.impacts[0].method_energy, -0.125);
  EXPECT_EQ(back.impacts[1].method_energy, 0.0);
}

TEST_F(SummaryTest, ReadsWhatBecameOfExpectations) {
  RunSummary summary;
  summary.expectations = {
      {.name = "force",
       .quantity = "max(history.force)",
       .published = "elsewhere: 5",
       .value = INFINITY,
       .expected = "5 within 0.5",
       .expected_value = 5.0,
       .tolerance = 0.5,
       .location = "a.toml:1:2",
       .holds = false},
      {.quantity = "summary.steps", .expected = "≤ 3", .maximum = 3.0, .checked = false, .note = "no"}};
  const RunSummary back = read_back(summary);
  ASSERT_EQ(back.expectations.size(), 2U);
  const ExpectationResult &first = back.expectations[0], &second = back.expectations[1];
  EXPECT_EQ(first.name, "force");
  EXPECT_EQ(first.quantity, "max(history.force)");
  EXPECT_EQ(first.published, "elsewhere: 5");
  EXPECT_EQ(first.value, INFINITY);
  EXPECT_EQ(first.expected, "5 within 0.5");
  EXPECT_EQ(first.expected_value, 5.0);
  EXPECT_EQ(first.tolerance, 0.5);
  EXPECT_EQ(first.location, "a.toml:1:2");
  EXPECT_TRUE(first.checked);
  EXPECT_FALSE(first.holds);
  EXPECT_FALSE(first.minimum.has_value() || first.maximum.has_value());
  EXPECT_EQ(second.maximum, 3.0);
  EXPECT_FALSE(second.expected_value.has_value() || second.checked);
  EXPECT_EQ(second.note, "no");
  EXPECT_EQ(first.label(), "force");
  EXPECT_EQ(second.label(), "summary.steps");
  const std::string text = to_json(summary);
  EXPECT_EQ(summary_value(text, "expectations.0.wanted_value"), 5.0);
  EXPECT_EQ(summary_value(text, "expectations.1.maximum"), 3.0);
}

TEST_F(SummaryTest, NamesTheFileThatListsAnImpactOfNoBody) {
  RunSummary summary;
  summary.impacts.emplace_back();
  summary.impacts.back().body = 3;
  try {
    (void)read_back(summary);
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
    EXPECT_NE(std::string(error.what()).find(path() + ": "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("body 3"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ricochet
