#include "ricochet/study/result_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "ricochet/base/text.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/simulation/impact/restitution.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"

namespace ricochet {

namespace {

/// Returns true unless a warning concerns the case only, not its results.
bool concerns_validity(const std::string& warning) { return !warning.starts_with(end_warning); }

/// Returns a coordinate of the position of the largest stress, for each of the dimensions.
TableCell peak_coordinate(const RunSummary& s, std::size_t k) {
  return s.peak_stress && k < s.peak_stress->position.size() ? TableCell(s.peak_stress->position[k]) : TableCell();
}

/// A column and the function that fills its cells.
struct ResultColumn {
  TableColumn column;
  std::function<TableCell(const std::string& run, const RunState& state)> cell;
};

/// Makes a column that is empty for a run without a summary.
ResultColumn of_summary(TableColumn column, TableCell (*cell)(const RunSummary&)) {
  return {std::move(column), [cell](const std::string&, const RunState& state) {
            return state.summary ? cell(*state.summary) : TableCell();
          }};
}

TableCell restitution_of(const RunSummary& s) {
  const Impact* const first = s.first_restitution();
  return first != nullptr ? TableCell(*first->restitution()) : TableCell();
}

TableCell largest_force_of(const RunSummary& s) {
  const Impact* const most = s.hardest_impact();
  return most != nullptr ? TableCell(most->largest_force) : TableCell();
}

TableCell exit_status_of(const RunState& state) {
  const std::optional<int> status = state.final_status();
  return status ? TableCell(long(*status)) : TableCell();
}

using Summary = const RunSummary&;

/// Returns all columns in their order.
const std::vector<ResultColumn>& all_columns() {
  static const std::vector<ResultColumn> columns{
      {{"run", false}, [](const std::string& run, const RunState&) { return TableCell(run); }},
      {{"status"}, [](const std::string&, const RunState& state) { return TableCell(state.status_text()); }},
      {{"exit_status", false}, [](const std::string&, const RunState& state) { return exit_status_of(state); }},
      of_summary({"steps"}, [](Summary s) { return TableCell(s.steps); }),
      of_summary({"time", false}, [](Summary s) { return TableCell(s.time()); }),
      of_summary({"processor_seconds", true, 3}, [](Summary s) { return TableCell(s.processor_seconds); }),
      of_summary({"lost_by_method", true, 3}, [](Summary s) { return TableCell(s.method_energy.lost); }),
      of_summary({"created_by_method", true, 3}, [](Summary s) { return TableCell(s.method_energy.created); }),
      of_summary({"max_penetration", true, 3}, [](Summary s) { return TableCell(s.deepest_penetration()); }),
      of_summary({"impacts", false}, [](Summary s) { return TableCell(long(s.impacts.size()) + s.impacts_left_out); }),
      of_summary({"restitution", true, 4, 1}, restitution_of),
      of_summary({"largest_force", true, 4, 1}, largest_force_of),
      of_summary({"peak_von_mises", true, 4, 1},
                 [](Summary s) { return s.peak_stress ? TableCell(s.peak_stress->peak.von_mises) : TableCell(); }),
      of_summary({"peak_von_mises_time", false},
                 [](Summary s) { return s.peak_stress ? TableCell(s.peak_stress->peak.time) : TableCell(); }),
      of_summary({"peak_von_mises_x", false}, [](Summary s) { return peak_coordinate(s, 0); }),
      of_summary({"peak_von_mises_y", false}, [](Summary s) { return peak_coordinate(s, 1); }),
      of_summary({"peak_von_mises_z", false}, [](Summary s) { return peak_coordinate(s, 2); }),
      of_summary({"warnings", false}, [](Summary s) { return TableCell(long(s.warnings.size())); }),
      of_summary({"doubts", true, 4, 1}, [](Summary s) { return TableCell(doubts_of(s)); })};
  return columns;
}

}  // namespace

std::string doubts_of(const RunSummary& s) {
  std::vector<std::string> doubts;
  if (const Impact* const first = s.first_restitution(); first != nullptr) {
    if (!restitution_doubt(*first).empty())
      doubts.emplace_back(*first->restitution() < 0.0 ? "restitution: negative" : "restitution: above 1");
    if (restitution_error(*first).is_large) doubts.emplace_back("restitution: inexact");
    if (!s.rotation.holds_in_impact(s.number_of(*first))) doubts.emplace_back("restitution: cells turned");
    if (is_distorted_by_rotation(*first)) doubts.emplace_back("restitution: the body turned");
  }
  if (const Impact* const most = s.hardest_impact(); most != nullptr && most->is_coarse())
    doubts.emplace_back("largest_force: coarse contact");
  if (s.peak_stress && s.peak_stress->peak.evaluations < s.peak_stress->peak.states)
    doubts.emplace_back("peak_von_mises: at least");
  if (s.peak_stress && s.peak_stress->peak.raised_by != StressRaiser::none)
    doubts.emplace_back("peak_von_mises: grows with refinement");
  const auto warnings = std::ranges::count_if(s.warnings, concerns_validity);
  if (warnings > 0) doubts.push_back(counted(warnings, "warning"));
  return fmt::format("{}", fmt::join(doubts, "; "));
}

std::vector<TableColumn> result_columns() {
  std::vector<TableColumn> columns;
  for (const ResultColumn& one : all_columns()) columns.push_back(one.column);
  return columns;
}

std::vector<TableCell> result_cells(const std::string& run, const RunState& state) {
  std::vector<TableCell> cells;
  for (const ResultColumn& one : all_columns()) cells.push_back(one.cell(run, state));
  return cells;
}

}  // namespace ricochet
