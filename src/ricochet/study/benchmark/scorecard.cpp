#include "ricochet/study/benchmark/scorecard.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// Percentage of the largest energy below which nothing is shown.
constexpr double shown_percent = 0.05;

/// Returns the percentage with two digits, or with all digits before the decimal point.
std::string percent_text(double percent) {
  if (percent < shown_percent) return "0";
  return percent < 9.95 ? fmt::format("{:.1f}", percent) : fmt::format("{:.0f}", percent);
}

bool is_done(const BenchmarkRunResult& result) { return result.state.status_text() == "done"; }

/// Returns a text such as "14/15 +0.1 −3 %", with the energy created and lost if large enough to show.
std::string done_text(const BenchmarkRunResult& result) {
  std::string text = fmt::format("{}/{}", result.holds(), result.applies());
  const double created = 100.0 * result.state.summary->method_energy.created;
  const double lost = 100.0 * result.state.summary->method_energy.lost;
  if (created >= shown_percent) text += " +" + percent_text(created);
  if (lost >= shown_percent) text += " −" + percent_text(lost);
  return text + (created >= shown_percent || lost >= shown_percent ? " %" : "");
}

class MatrixMaker {
 public:
  MatrixMaker(const BenchmarkPlan& plan, const BenchmarkResults& results);
  ScorecardMatrix make();

 private:
  /// Returns the indices of the runs of a method.
  [[nodiscard]] std::vector<std::size_t> runs_of(const std::string& method) const;
  [[nodiscard]] std::string masses_of(const std::string& method) const;
  [[nodiscard]] std::string cell_of(std::size_t run);
  void add_totals(const std::string& method);
  void add_part(const std::string& group);

  const BenchmarkPlan& plan_;
  const BenchmarkResults& results_;
  std::vector<std::string> methods_, groups_;
  ScorecardMatrix matrix_;
};

MatrixMaker::MatrixMaker(const BenchmarkPlan& plan, const BenchmarkResults& results) : plan_(plan), results_(results) {
  const auto add = [](std::vector<std::string>& list, const std::string& entry) {
    if (std::ranges::count(list, entry) == 0) list.push_back(entry);
  };
  for (const BenchmarkRun& run : plan.runs) {
    add(methods_, run.method);
    add(groups_, run.benchmark.group);
  }
}

std::vector<std::size_t> MatrixMaker::runs_of(const std::string& method) const {
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < plan_.runs.size(); ++i) {
    if (plan_.runs[i].method == method) runs.push_back(i);
  }
  return runs;
}

std::string MatrixMaker::masses_of(const std::string& method) const {
  std::vector<std::string> masses;
  for (const std::size_t i : runs_of(method)) {
    const std::string& mass = plan_.runs[i].mass;
    if (!mass.empty() && std::ranges::count(masses, mass) == 0) masses.push_back(mass);
  }
  return masses.empty() ? "none" : join_names(masses, " or ", false);
}

std::string MatrixMaker::cell_of(std::size_t run) {
  const BenchmarkRunResult& result = results_.run_results[run];
  if (is_done(result)) return done_text(result);
  if (result.state.status_text() != "refused") return result.status_text();
  auto found = std::ranges::find(matrix_.reasons, result.message);
  if (found == matrix_.reasons.end()) found = matrix_.reasons.insert(found, result.message);
  return fmt::format("refused ({})", found - matrix_.reasons.begin() + 1);
}

void MatrixMaker::add_totals(const std::string& method) {
  long all_right = 0, run = 0, refused = 0, failed = 0;
  std::size_t holds = 0, applies = 0;
  double created = 0.0, lost = 0.0;
  for (const std::size_t i : runs_of(method)) {
    const BenchmarkRunResult& result = results_.run_results[i];
    if (result.state.status_text() == "refused") {
      ++refused;
      continue;
    }
    ++run;
    failed += result.state.status_text() == "failed";
    holds += result.holds();
    applies += result.applies();
    all_right += is_done(result) && result.holds() == result.applies();
    if (!is_done(result)) continue;
    created = std::max(created, 100.0 * result.state.summary->method_energy.created);
    lost = std::max(lost, 100.0 * result.state.summary->method_energy.lost);
  }
  matrix_.totals.rows.push_back({plan_.runs[runs_of(method).front()].scheme, masses_of(method), run, all_right, failed,
                                 refused, run > 0 ? TableCell(fmt::format("{}/{}", holds, applies)) : TableCell(),
                                 run > 0 ? TableCell(percent_text(created) + " %") : TableCell(),
                                 run > 0 ? TableCell(percent_text(lost) + " %") : TableCell()});
}

void MatrixMaker::add_part(const std::string& group) {
  ScorecardPart& part = matrix_.parts.emplace_back();
  part.title = group;
  part.table.columns = {{"scheme"}, {"mass"}};
  part.table.key_columns = 2;
  for (const std::string& method : methods_) {
    std::vector<TableCell>& row = part.table.rows.emplace_back();
    row = {plan_.runs[runs_of(method).front()].scheme, masses_of(method)};
    for (const std::size_t i : runs_of(method)) {
      const Benchmark& benchmark = plan_.runs[i].benchmark;
      if (benchmark.group != group) continue;
      if (part.table.rows.size() == 1) part.table.columns.push_back({benchmark.name});
      row.emplace_back(cell_of(i));
    }
  }
}

ScorecardMatrix MatrixMaker::make() {
  matrix_.totals.columns = {{"scheme"},  {"mass"},   {"benchmarks"},   {"all values hold"}, {"failed"},
                            {"refused"}, {"values"}, {"max. created"}, {"max. lost"}};
  matrix_.totals.key_columns = 2;
  for (const std::string& method : methods_) add_totals(method);
  for (const std::string& group : groups_) add_part(group);
  return std::move(matrix_);
}

std::string in_words(const ScorecardMatrix& matrix, const char* heading, const char* item,
                     std::string (*write)(const ResultTable&), std::string (*write_text)(const std::string&)) {
  std::string text = write(matrix.totals) + "\n";
  for (const ScorecardPart& part : matrix.parts) {
    if (!part.title.empty()) text += fmt::format("{}{}\n\n", heading, write_text(part.title));
    text += write(part.table) + "\n";
  }
  if (!matrix.reasons.empty()) text += "Refused:\n\n";
  for (std::size_t i = 0; i < matrix.reasons.size(); ++i)
    text += fmt::format("{}{}. {}\n", item, i + 1, write_text(matrix.reasons[i]));
  return text;
}

}  // namespace

ResultTable scorecard_table(const BenchmarkPlan& plan, const BenchmarkResults& results) {
  ResultTable table;
  for (const char* name : {"scheme", "mass", "benchmark", "holds", "applies", "created_percent", "lost_percent",
                           "status", "processor_seconds", "steps", "time_step", "message"})
    table.columns.push_back({name});
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const BenchmarkRun& run = plan.runs[i];
    const BenchmarkRunResult& result = results.run_results[i];
    std::vector<TableCell>& row = table.rows.emplace_back();
    row = {run.scheme, run.mass, run.benchmark.name};
    if (result.state.status_text() == "refused") {
      row.resize(5);
    } else {
      row.insert(row.end(), {long(result.holds()), long(result.applies())});
    }
    if (const auto& s = result.state.summary; s) {
      row.insert(row.end(), {100.0 * s->method_energy.created, 100.0 * s->method_energy.lost, result.status_text(),
                             s->processor_seconds, s->steps, s->step});
    } else {
      row.insert(row.end(), {TableCell(), TableCell(), result.status_text(), TableCell(), TableCell(), TableCell()});
    }
    row.emplace_back(result.message);
  }
  return table;
}

ScorecardMatrix scorecard_matrix(const BenchmarkPlan& plan, const BenchmarkResults& results) {
  return MatrixMaker(plan, results).make();
}

std::string scorecard_in_markdown(const BenchmarkPlan& plan, const BenchmarkResults& results) {
  return in_words(scorecard_matrix(plan, results), "### ", "", to_markdown, markdown_text);
}

std::string scorecard_in_aligned_text(const BenchmarkPlan& plan, const BenchmarkResults& results) {
  return in_words(scorecard_matrix(plan, results), "", "  ", to_aligned_text,
                  [](const std::string& text) { return text; });
}

}  // namespace ricochet
