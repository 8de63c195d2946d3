#include "ricochet/study/outcome_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/text.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/simulation/restitution.hpp"

namespace ricochet {

namespace {

using Impacts = std::vector<Impact>;

Impacts::const_iterator first_with_restitution(const Impacts& impacts) {
  return std::find_if(impacts.begin(), impacts.end(),
                      [](const Impact& impact) { return impact.restitution().has_value(); });
}

Impacts::const_iterator hardest(const Impacts& impacts) {
  return std::max_element(impacts.begin(), impacts.end(),
                          [](const Impact& a, const Impact& b) { return a.largest_force < b.largest_force; });
}

/// Of the case itself, and not of what came out.
bool concerns_validity(const std::string& warning) {
  return !warning.starts_with(end_warning);
}

/// Whether numbers of that impact are those of a body that small strain describes.
bool is_strained(const RunSummary& s, Impacts::const_iterator impact) {
  return !s.small_strain_holds_in(static_cast<std::size_t>(impact - s.impacts.begin()));
}

/// As many as the columns of the largest stress.
std::vector<TableCell> peak_cells(const RunSummary& s) {
  if (!s.peak_stress) return std::vector<TableCell>(5);
  const PeakStressDescription& d = *s.peak_stress;
  std::vector<TableCell> cells{d.peak.von_mises, d.peak.time};
  for (std::size_t k = 0; k < 3; ++k) cells.push_back(k < d.place.size() ? TableCell(d.place[k]) : TableCell());
  return cells;
}

}  // namespace

std::string doubts_of(const RunSummary& s) {
  std::vector<std::string> doubts;
  if (const auto first = first_with_restitution(s.impacts); first != s.impacts.end()) {
    if (restitution_error(*first).is_large) doubts.emplace_back("restitution: made by the method");
    if (is_strained(s, first)) doubts.emplace_back("restitution: cells turned");
  }
  if (const auto most = hardest(s.impacts); most != s.impacts.end() && most->is_coarse())
    doubts.emplace_back("largest_force: coarse contact");
  if (s.peak_stress && s.peak_stress->peak.looks < s.peak_stress->peak.states)
    doubts.emplace_back("peak_von_mises: at least");
  const auto warnings = std::count_if(s.warnings.begin(), s.warnings.end(), concerns_validity);
  if (warnings > 0) doubts.push_back(counted(warnings, "warning"));
  return fmt::format("{}", fmt::join(doubts, "; "));
}

std::vector<TableColumn> outcome_columns() {
  return {{"run", false},
          {"status"},
          {"exit_status", false},
          {"steps"},
          {"time", false},
          {"processor_seconds", true, 3},
          {"lost_by_method", true, 3},
          {"created_by_method", true, 3},
          {"max_penetration", true, 3},
          {"impacts", false},
          {"restitution", true, 4, 1},
          {"largest_force", true, 4, 1},
          {"peak_von_mises", true, 4, 1},
          {"peak_von_mises_time", false},
          {"peak_von_mises_x", false},
          {"peak_von_mises_y", false},
          {"peak_von_mises_z", false},
          {"warnings", false},
          {"doubts", true, 4, 1}};
}

std::vector<TableCell> outcome_cells(const std::string& run, const RunState& state) {
  const std::optional<int> status = state.final_status();
  std::vector<TableCell> cells{run, state.word(), status ? TableCell(static_cast<long>(*status)) : TableCell()};
  if (!state.summary) {
    cells.resize(outcome_columns().size());
    return cells;
  }
  const RunSummary& s = *state.summary;
  const auto first = first_with_restitution(s.impacts), most = hardest(s.impacts);
  cells.insert(cells.end(), {s.steps, s.time(), s.processor_seconds, s.loss_by_method(), s.creation_by_method(),
                             s.deepest_penetration(), static_cast<long>(s.impacts.size()) + s.impacts_left_out,
                             first != s.impacts.end() ? TableCell(*first->restitution()) : TableCell(),
                             most != s.impacts.end() ? TableCell(most->largest_force) : TableCell()});
  for (TableCell& cell : peak_cells(s)) cells.push_back(std::move(cell));
  cells.emplace_back(static_cast<long>(s.warnings.size()));
  cells.emplace_back(doubts_of(s));
  return cells;
}

}  // namespace ricochet
