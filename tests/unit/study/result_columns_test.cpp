#include "ricochet/study/result_columns.hpp"

#include <gtest/gtest.h>

#include <map>

/// @file Each column has its own number of the run; a run without that number has an empty cell.
namespace ricochet {
namespace {

/// Impact of a body of mass 4: down with velocity 2, up with 1.5, so that e = 0.75.
Impact bounce(double largest_force) {
  Impact impact;
  impact.mass = 4.0;
  impact.normal_impulse = impact.impulse = Eigen::Vector3d(0.0, 4.0 * 3.5, 0.0);
  impact.before.velocity = Eigen::Vector3d(0.0, -2.0, 0.0);
  impact.before.kinetic_energy = impact.before.rigid_kinetic_energy = 8.0;
  impact.after.velocity = Eigen::Vector3d(0.0, 1.5, 0.0);
  impact.after.kinetic_energy = impact.after.rigid_kinetic_energy = 4.5;
  impact.largest_force = largest_force;
  impact.method_energy = 0.0;
  return impact;
}

RunState finished_run() {
  RunState state;
  RunSummary& s = state.summary.emplace();
  s.steps = 250;
  s.step = 0.5;
  s.processor_seconds = 17.5;
  s.method_energy = MethodEnergy{.lost = 0.125, .created = 0.0625};
  Impact unfinished = bounce(11.0);
  unfinished.ended = false;
  s.impacts = {unfinished, bounce(90.0), bounce(30.0)};
  s.impacts_left_out = 4;
  s.peak_stress.emplace();
  s.peak_stress->peak.von_mises = 1234.5;
  s.peak_stress->peak.time = 6.25;
  s.peak_stress->position = {0.1, 0.2};
  s.penetration.found.push_back({});
  s.penetration.found.back().depth = 0.03;
  s.rotation.limit = 0.1;
  s.warnings = {"one", "two"};
  return state;
}

std::map<std::string, TableCell> by_name(const std::string& run, const RunState& state) {
  const std::vector<TableColumn> columns = result_columns();
  const std::vector<TableCell> cells = result_cells(run, state);
  EXPECT_EQ(columns.size(), cells.size());
  std::map<std::string, TableCell> result;
  for (std::size_t i = 0; i < columns.size(); ++i) result[columns[i].name] = cells.at(i);
  EXPECT_EQ(result.size(), columns.size()) << "a name is there twice";
  return result;
}

TEST(OutcomeColumns, DoubtARestitutionThatTheTurnOfABodyHasChanged) {
  RunSummary summary = *finished_run().summary;
  EXPECT_EQ(doubts_of(summary).find("restitution: the body turned"), std::string::npos);
  summary.impacts[1].rotation_growth = 0.0125;
  EXPECT_NE(doubts_of(summary).find("restitution: the body turned"), std::string::npos) << doubts_of(summary);
}

TEST(OutcomeColumns, HaveTheNumbersOfTheRun) {
  const std::map<std::string, TableCell> cells = by_name("007-step=0.5", finished_run());
  const std::map<std::string, std::string> expected{{"run", "007-step=0.5"},
                                                    {"status", "done"},
                                                    {"exit_status", "0"},
                                                    {"steps", "250"},
                                                    {"time", "125"},
                                                    {"processor_seconds", "17.5"},
                                                    {"lost_by_method", "0.125"},
                                                    {"created_by_method", "0.0625"},
                                                    {"max_penetration", "0.03"},
                                                    {"impacts", "7"},
                                                    {"restitution", "0.75"},
                                                    {"largest_force", "90"},
                                                    {"peak_von_mises", "1234.5"},
                                                    {"peak_von_mises_time", "6.25"},
                                                    {"peak_von_mises_x", "0.1"},
                                                    {"peak_von_mises_y", "0.2"},
                                                    {"peak_von_mises_z", ""},
                                                    {"warnings", "2"},
                                                    {"doubts", "2 warnings"}};
  for (const auto& [name, cell] : cells) EXPECT_EQ(text_of(cell), expected.at(name)) << name;
  EXPECT_EQ(cells.size(), expected.size());
}

TEST(OutcomeColumns, AreEmptyWhereTheRunHasNothing) {
  RunState refused;
  refused.exit_status = 2;
  for (const auto& [name, cell] : by_name("001", refused)) {
    const std::string wanted = name == "run" ? "001" : name == "status" ? "refused" : name == "exit_status" ? "2" : "";
    EXPECT_EQ(text_of(cell), wanted) << name;
  }
  RunState quiet = finished_run();
  quiet.summary->impacts.clear();
  quiet.summary->peak_stress.reset();
  quiet.summary->warnings.clear();
  const auto cells = by_name("001", quiet);
  for (const char* name : {"restitution", "largest_force", "peak_von_mises", "peak_von_mises_time", "peak_von_mises_x",
                           "peak_von_mises_y", "peak_von_mises_z", "doubts"})
    EXPECT_EQ(text_of(cells.at(name)), "") << name;
  EXPECT_EQ(text_of(cells.at("steps")), "250");
}

}  // namespace
}  // namespace ricochet
