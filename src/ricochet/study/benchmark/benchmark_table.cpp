#include "ricochet/study/benchmark/benchmark_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/study/benchmark/methods.hpp"
#include "ricochet/study/benchmark/scorecard.hpp"

namespace ricochet {

namespace {

constexpr int not_met = int(ErrorKind::expectation), refused = int(ErrorKind::invalid_input);

/// Returns the results of the expectations that apply to this run, if its case can be read.
std::vector<ExpectationResult> expectations_of(const BenchmarkRun& run, const std::string& directory,
                                               const BenchmarkRunResult& result) {
  const log::Silence silence;  // the run has issued the warnings
  std::vector<ExpectationResult> all;
  try {
    const Case input = read_case(run.benchmark.case_path, run.settings);
    all = result.state.status_text() == "done"
              ? check_expectations(input, directory, result.state.summary_json, ExpectationScope::any_settings)
              : unmet_expectations(input, result.message, ExpectationScope::any_settings);
  } catch (const Error&) {
    return {};
  }
  std::erase_if(all, [](const ExpectationResult& e) { return !e.checked; });
  return all;
}

int status_of(const BenchmarkRun& run, const BenchmarkRunResult& result) {
  if (result.state.status_text() == "done") return result.holds() == result.applies() ? 0 : not_met;
  const int status = result.state.exit_status.value_or(0);
  return status == refused && !run.is_own_method ? 0 : status;
}

/// Returns a text such as "≥ 1 and ≤ 2".
std::string bounds_text(const ExpectationResult& e) {
  std::string text;
  if (e.minimum) text = fmt::format("≥ {}", *e.minimum);
  if (e.maximum) text += fmt::format("{}≤ {}", text.empty() ? "" : " and ", *e.maximum);
  return text;
}

TableCell reference_cell(const ExpectationResult& e) {
  return e.expected_value ? TableCell(*e.expected_value) : TableCell(bounds_text(e));
}

double error_of(const ExpectationResult& e) {
  if (e.expected_value) return e.value - *e.expected_value;
  if (e.minimum && e.value < *e.minimum) return e.value - *e.minimum;
  if (e.maximum && e.value > *e.maximum) return e.value - *e.maximum;
  return 0.0;
}

std::vector<TableCell> cells_of(const BenchmarkRun& run, const ExpectationResult& e) {
  const bool has_value = e.note.empty();
  return {run.benchmark.name,
          e.label(),
          reference_cell(e),
          has_value ? TableCell(e.value) : TableCell(),
          has_value ? TableCell(error_of(e)) : TableCell(),
          e.tolerance ? TableCell(*e.tolerance) : TableCell(),
          e.published,
          run.scheme,
          run.mass,
          e.holds ? "yes" : "no"};
}

std::string title_of(const BenchmarkPlan& plan, const BenchmarkRun& run) {
  return run.benchmark.name + (plan.is_scorecard ? ", " + run.method : "");
}

}  // namespace

std::size_t BenchmarkRunResult::holds() const {
  return std::size_t(std::ranges::count_if(expectations, [](const ExpectationResult& e) { return e.holds; }));
}

std::string BenchmarkRunResult::status_text() const {
  const std::string word = state.status_text();
  if (word != "failed" || !state.summary) return word;
  const RunSummary& s = *state.summary;
  return fmt::format("failed at t = {:.3g}", s.adaptive ? s.adaptive->time : double(s.steps) * s.step);
}

BenchmarkResults read_benchmark_results(const BenchmarkPlan& plan) {
  BenchmarkResults results;
  for (const BenchmarkRun& run : plan.runs) {
    BenchmarkRunResult& result = results.run_results.emplace_back();
    if (run.refusal.empty()) {
      result.state = read_run_state(plan.path(run));
      result.message = result.state.status_text() == "done" ? "" : short_reason(result.state.message);
    } else {
      result.state.exit_status = refused;
      result.message = run.refusal;
    }
    if (!result.message.empty() || result.state.status_text() == "done")
      result.expectations = expectations_of(run, plan.path(run), result);
    results.worst_status = worse_status(results.worst_status, status_of(run, result));
  }
  return results;
}

ResultTable benchmark_table(const BenchmarkPlan& plan, const BenchmarkResults& results) {
  ResultTable table{{{"case"},
                     {"quantity"},
                     {"reference", true, 6},
                     {"value", true, 6},
                     {"error", true, 2},
                     {"tolerance", true, 2},
                     {"published"},
                     {"scheme"},
                     {"mass"},
                     {"holds"}},
                    {},
                    2};
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    // A refusal does not count against a method.
    if (results.run_results[i].state.status_text() == "refused" && !plan.runs[i].is_own_method) continue;
    for (const ExpectationResult& e : results.run_results[i].expectations)
      table.rows.push_back(cells_of(plan.runs[i], e));
  }
  return table;
}

ResultTable benchmark_table_for_readers(const BenchmarkPlan& plan, const BenchmarkResults& results,
                                        bool with_published) {
  ResultTable table = benchmark_table(plan, results);
  const std::size_t holds = table.find("holds");
  for (auto& row : table.rows) row[holds] = std::get<std::string>(row[holds]) == "yes" ? "" : "DOES NOT HOLD";
  table.columns[holds].name = " ";
  table.columns[table.find("published")].is_for_readers = with_published;
  for (const char* name : {"scheme", "mass"}) table.columns[table.find(name)].is_for_readers = plan.is_scorecard;
  return table;
}

std::vector<std::string> benchmark_notes(const BenchmarkPlan& plan, const BenchmarkResults& results) {
  std::size_t holds = 0, applies = 0;
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const BenchmarkRunResult& result = results.run_results[i];
    const bool is_refused = result.state.status_text() == "refused";
    if (is_refused && !plan.runs[i].is_own_method) continue;
    holds += result.holds();
    applies += result.applies();
    if (result.state.status_text() == "done") continue;
    const std::string why = result.message.empty() ? "" : ": " + result.message;
    notes.push_back(fmt::format("{}: {}{}", title_of(plan, plan.runs[i]), result.status_text(), why));
  }
  notes.push_back(fmt::format("{} of {} hold.", holds, counted(applies, "expected value")));
  return notes;
}

void write_benchmark_tables(const BenchmarkPlan& plan, const BenchmarkResults& results) {
  write_durably(plan.path("benchmark.csv"), to_csv(benchmark_table(plan, results)));
  std::string page = "# Benchmarks\n\n" + to_markdown(benchmark_table_for_readers(plan, results, true)) + "\n";
  for (const std::string& note : benchmark_notes(plan, results)) page += fmt::format("- {}\n", markdown_text(note));
  std::vector<std::string> reported;
  page += "\nThe benchmarks:\n\n";
  for (const BenchmarkRun& run : plan.runs) {
    if (std::ranges::count(reported, run.benchmark.name) > 0) continue;
    reported.push_back(run.benchmark.name);
    page += fmt::format("- `{}`: {}\n", run.benchmark.name, markdown_text(run.benchmark.description));
  }
  write_durably(plan.path("benchmark.md"), page);
  if (!plan.is_scorecard) return;
  write_durably(plan.path("scorecard.csv"), to_csv(scorecard_table(plan, results)));
  write_durably(plan.path("scorecard.md"), "# Scorecard\n\n" + scorecard_in_markdown(plan, results));
}

}  // namespace ricochet
