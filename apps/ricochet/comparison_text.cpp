#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "ricochet/base/text.hpp"
#include "ricochet/fem/cell_rotations.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/simulation/impact/restitution.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

struct Run {
  std::string directory;
  RunSummary summary;
};

/// Returns the total variation of the component of a resultant contact force that varies most.
double force_variation(const RunSummary& s) {
  double variation = 0.0;
  for (const std::string& column : s.columns) {
    if (column.starts_with("contact_force_") || column.starts_with("pair_force."))
      variation = std::max(variation, s.digest(column).total_variation);
  }
  return variation;
}

/// Returns the variation of the normal reaction at each probe on a contact boundary, or "".
std::string probe_variations(const RunSummary& s, const char* sign) {
  std::vector<std::string> texts;
  for (const auto& [probe, position] : s.probes) {
    if (probe.contact_node < 0) continue;
    const std::string column = probe.name + ".reaction_normal";
    texts.push_back(fmt::format("{} {}{:.4g}", column, sign, s.digest(column).total_variation));
  }
  return texts.empty() ? "" : fmt::format("variation of {}", fmt::join(texts, ", "));
}

void print_methods(const std::vector<Run>& runs, int width) {
  std::size_t scheme_width = 15;
  for (const auto& [directory, s] : runs) scheme_width = std::max(scheme_width, s.scheme.size());
  constexpr const char* row = "{:<{}} {:<{}} {:<18} {:>11} {:>11} {:>11} {:>11} {:>14} {:>14} {:>9}\n";
  fmt::print(row, "run", width, "scheme", scheme_width, "mass", "energy at", "energy at", "largest", "energy by",
             "variation of", "deepest inter-", "time per");
  fmt::print(row, "", width, "", scheme_width, "", "the start", "the end", "energy", "the method", "contact force",
             "penetration", "step, ms");
  bool any_skips = false, any_force = false;
  for (const auto& [directory, s] : runs) {
    const ColumnDigest energy = s.digest("total_energy");
    const bool skips = s.history_every > 1;
    any_skips = any_skips || skips;
    any_force = any_force || force_variation(s) > 0.0;
    fmt::print("{:<{}} {:<{}} {:<18} {:>11.6g} {:>11.6g} {:>11.6g} {:>11} {:>14} {:>14} {:>9.3g}{}\n", directory, width,
               s.scheme, scheme_width, s.mass, energy.first, energy.last, energy.maximum, method_energy_mark(s),
               fmt::format("{}{:.4g}", skips ? "≥ " : "", force_variation(s)), deepest_penetration_text(s),
               1e3 * s.time_per_step, status_text(directory, s));
  }
  if (any_force)
    fmt::print(
        "  variation of contact force: the total variation of contact_force_* or pair_force.*, whichever varies most, "
        "in the unit of force of the case (in plane cases per thickness)\n");
  if (any_skips)
    fmt::print(
        "  ≥ the history has no row for some steps: a force that alternates from step to step varies more "
        "(output.history_every)\n");
  for (const auto& [directory, s] : runs) {
    std::vector<std::string> notes;
    if (s.mass_built != s.mass) notes.push_back("mass " + s.mass_text());
    if (const std::string reactions = reactions_text(s); !reactions.empty()) notes.push_back("reactions: " + reactions);
    if (const std::string probes = probe_variations(s, s.history_every > 1 ? "≥ " : ""); !probes.empty())
      notes.push_back(probes);
    if (!notes.empty()) fmt::print("  {}: {}\n", directory, fmt::join(notes, "; "));
  }
}

/// Marks and their meanings, in the order of their explanation.
constexpr std::array<std::pair<const char*, const char*>, 7> meanings{{
    {"≥", "not every step was evaluated: the stress may have been higher in between (output.fields_every)"},
    {"~", "the contact zone is too coarse for a reliable force: refine the mesh there"},
    {"?",
     "cells rotate by more than 0.1 rad, which causes a spurious strain under small strain, or the body rotates by "
     "more than the impact tolerates; `ricochet info` of the run alone says which"},
    {"^",
     "the stress of linear elasticity is infinite there, as at a re-entrant edge, and the value grows with refinement: "
     "`ricochet info` of the run alone says what it sits on"},
    {"!",
     "the method itself lost or created more than a tenth of the energy loss that this restitution implies: use a "
     "smaller time.step and smaller cells"},
    {"±",
     "negative or above 1: the body left while it still moved inward, or with energy of deformation or rotation; it "
     "may touch again"},
    {"*", "of the first impact with a restitution; there are more, which `ricochet info` of the run alone lists"},
}};

/// Numbers of a run for the table. Marks are added to `marks`.
class ResultCells {
 public:
  ResultCells(const RunSummary& summary, std::set<std::string>& marks) : s_(summary), marks_(marks) {}

  [[nodiscard]] std::string restitution() const {
    const Impact* const first = s_.first_restitution();
    if (first == nullptr) return "-";
    const bool more = s_.impacts.size() > 1 || s_.impacts_left_out > 0;
    return fmt::format("{:.4g}", *first->restitution()) + mark("*", more) + mark("?", rotated_too_far_in(*first)) +
           mark("!", restitution_error(*first).is_large) + mark("±", !restitution_doubt(*first).empty());
  }

  /// Returns the largest force of a body on an obstacle; "-" if the results contain no impacts.
  [[nodiscard]] std::string largest_force() const {
    const Impact* const hardest = s_.hardest_impact();
    if (hardest == nullptr) return "-";
    return fmt::format("{:.4g}", hardest->largest_force) + mark("~", hardest->is_coarse()) +
           mark("?", rotated_too_far_in(*hardest));
  }

  [[nodiscard]] std::string peak_stress() const {
    if (!s_.peak_stress) return "-";
    const PeakStressResult& peak = s_.peak_stress->peak;
    return mark("≥", peak.evaluations < peak.states) + (peak.evaluations < peak.states ? " " : "") +
           fmt::format("{:.4g}", peak.von_mises) + mark("?", rotated_too_far_by(peak.time)) +
           mark("^", peak.raised_by != StressRaiser::none);
  }

 private:
  /// Returns true if cells or the body had rotated too far for small strain when the impact ended.
  [[nodiscard]] bool rotated_too_far_in(const Impact& impact) const {
    return !s_.small_strain_holds_in(s_.number_of(impact));
  }
  [[nodiscard]] bool rotated_too_far_by(double time) const { return s_.rotation.time_beyond <= time; }
  [[nodiscard]] std::string mark(const char* sign, bool applies) const {
    if (!applies) return "";
    marks_.insert(sign);
    return sign;
  }

  const RunSummary& s_;
  std::set<std::string>& marks_;
};

void print_run_results(const std::vector<Run>& runs, int width) {
  std::set<std::string> marks;
  fmt::print("\n{:<{}} {:>12} {:>14} {:>14} {:>16}\n", "run", width, "impacts", "restitution", "largest force",
             "largest stress");
  for (const auto& [directory, summary] : runs) {
    const ResultCells cells(summary, marks);
    const std::size_t impacts = summary.impacts.size() + std::size_t(summary.impacts_left_out);
    fmt::print("{:<{}} {:>12} {:>14} {:>14} {:>16}\n", directory, width, impacts, cells.restitution(),
               cells.largest_force(), cells.peak_stress());
  }
  for (const auto& [mark, meaning] : meanings) {
    if (marks.contains(mark)) fmt::print("  {} {}\n", mark, meaning);
  }
}

}  // namespace

void print_comparison(const std::vector<std::string>& directories) {
  std::vector<Run> runs;
  std::size_t width = 24;
  for (const std::string& directory : directories) {
    runs.push_back({directory, read_summary_of_run(directory)});
    width = std::max(width, directory.size());
  }
  print_methods(runs, int(width));
  print_run_results(runs, int(width));
}

}  // namespace ricochet::program
