#include "ricochet/io/summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "ricochet/base/error.hpp"
#include "ricochet/base/temporary_folder.hpp"

namespace ricochet {
namespace {

class SummaryTest : public testing::Test {
 protected:
  [[nodiscard]] std::string path() const { return folder_.file("summary.json"); }
  [[nodiscard]] RunSummary read_back(const RunSummary& summary) const {
    write_summary(path(), summary);
    return read_summary(path());
  }

  TemporaryFolder folder_{std::filesystem::temp_directory_path(), "ricochet-test"};
};

TEST_F(SummaryTest, ReadsHowStepsWereSolvedAndWritten) {
  RunSummary summary;
  summary.history_every = 7;
  summary.solver = "iterative";
  summary.solver_reason = "the case asks for it";
  const RunSummary back = read_back(summary);
  EXPECT_EQ(back.history_every, summary.history_every);
  EXPECT_EQ(back.solver, summary.solver);
  EXPECT_EQ(back.solver_reason, summary.solver_reason);
}

/// A run that overflows between two rows of the history is stopped at the next row; what was found until then may be
/// infinite or no number, which JSON has no numbers for.
TEST_F(SummaryTest, ReadsWhatAnOverflowingRunHasWritten) {
  RunSummary summary;
  summary.penetration.checked = true;
  summary.penetration.found.push_back(
      {"floor", {"the body"}, INFINITY, INFINITY, 0.5, {-INFINITY, 2.0}, 0.25, {"top", "left"}});
  summary.penetration.rims.push_back({"bottom", "floor", 0.75, {1.0, NAN}, {"left"}});
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
  impact.first_place = {1.5, -INFINITY};
  impact.before.velocity = {INFINITY, -INFINITY, 0.0};
  summary.impacts.push_back(impact);
  summary.peak_stress = PeakStressDescription{{INFINITY, 0.5, 3, 7, 2, 4}, {1.5, 2.5}, 8, "steel"};

  const RunSummary back = read_back(summary);
  ASSERT_EQ(back.penetration.found.size(), 1u);
  const UnwatchedPenetration& found = back.penetration.found[0];
  EXPECT_EQ(found.depth, INFINITY);
  EXPECT_EQ(found.relative_depth, INFINITY);
  EXPECT_EQ(found.time, 0.5);
  EXPECT_EQ(found.place, (std::vector<double>{-INFINITY, 2.0}));
  EXPECT_EQ(found.first_time, 0.25);
  EXPECT_EQ(found.groups, (std::vector<std::string>{"top", "left"}));
  ASSERT_EQ(back.penetration.rims.size(), 1u);
  EXPECT_EQ(back.penetration.rims[0].time, 0.75);
  ASSERT_EQ(back.penetration.rims[0].place.size(), 2u);
  EXPECT_EQ(back.penetration.rims[0].place[0], 1.0);
  EXPECT_TRUE(std::isnan(back.penetration.rims[0].place[1]));
  ASSERT_EQ(back.impacts.size(), 1u);
  EXPECT_EQ(back.impacts[0].begin, 0.25);
  EXPECT_EQ(back.impacts[0].end, 0.5);
  EXPECT_EQ(back.impacts[0].contact_time, 0.25);
  EXPECT_EQ(back.impacts[0].largest_force, INFINITY);
  EXPECT_EQ(back.impacts[0].largest_force_time, 0.375);
  EXPECT_EQ(back.impacts[0].contact_points, 5);
  EXPECT_EQ(back.impacts[0].all_contact_points, 9);
  EXPECT_EQ(back.impacts[0].first_place, (std::vector<double>{1.5, -INFINITY}));
  EXPECT_EQ(back.impacts[0].before.velocity[1], -INFINITY);
  ASSERT_TRUE(back.peak_stress.has_value());
  EXPECT_EQ(back.peak_stress->peak.von_mises, INFINITY);
  EXPECT_EQ(back.peak_stress->place, (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(back.peak_stress->element, 8);
}

TEST_F(SummaryTest, KnowsInWhichImpactsCellsHadTurnedTooFar) {
  RunSummary summary;
  EXPECT_TRUE(summary.small_strain_holds_in_impacts());
  summary.bodies.push_back({{}, 0.1, "body \"left\""});
  summary.impacts.resize(2);
  summary.columns = {"max_rotation"};
  summary.digests = {{0.0, 0.3, 0.0, 0.3, 0.3}};
  EXPECT_FALSE(read_back(summary).small_strain_holds_in_impacts()) << "results that do not tell when";
  summary.rotation = RotationReport{0.1, 0.5, {0.0625, 0.1}};
  const RunSummary later = read_back(summary);
  EXPECT_EQ(later.bodies[0].name, "body \"left\"");
  ASSERT_TRUE(later.rotation.has_value());
  EXPECT_EQ(later.rotation->time_beyond, 0.5);
  EXPECT_TRUE(later.small_strain_holds_in_impacts());
  summary.rotation->until_impact_end[1] = 0.125;
  EXPECT_TRUE(read_back(summary).small_strain_holds_in(0));
  EXPECT_FALSE(read_back(summary).small_strain_holds_in(1));
  EXPECT_FALSE(read_back(summary).small_strain_holds_in_impacts());
  summary.rotation->time_beyond = INFINITY;
  EXPECT_EQ(read_back(summary).rotation->time_beyond, INFINITY);
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
