#pragma once

#include <string>
#include <vector>

#include "ricochet/io/summary.hpp"
#include "ricochet/study/benchmark/benchmark_files.hpp"
#include "ricochet/study/run_state.hpp"
#include "ricochet/study/table.hpp"

/// @file Results of benchmarks: a row for each reference value.
namespace ricochet {

/// Result of one benchmark with one method.
struct BenchmarkRunResult {
  RunState state;
  std::vector<ExpectationResult> expectations;  ///< those that apply; none holds if the run is not done
  std::string message;                          ///< reason why the run is not done, or ""

  [[nodiscard]] std::size_t applies() const { return expectations.size(); }
  [[nodiscard]] std::size_t holds() const;
  /// Returns "done", "refused", "failed at t = 0.5", "interrupted" or "not run".
  [[nodiscard]] std::string status_text() const;
};

struct BenchmarkResults {
  std::vector<BenchmarkRunResult> run_results;  ///< in the order of the plan's runs
  int worst_status = 0;  ///< 0: all hold; 5: some do not; else the worst of the runs. Refusals by a scheme other
                         ///< than that of the case do not count.
};

/// Reads the results of all runs as far as they exist, and evaluates the [[expect]] entries of their cases that apply,
/// whatever the settings.
[[nodiscard]] BenchmarkResults read_benchmark_results(const BenchmarkPlan& plan);

/// Makes the table for programs: case, quantity, reference, value, error, tolerance, published, scheme, mass, holds.
/// The reference is a number, or bounds ("≤ 1"); the error is value − reference, and for bounds the distance of the
/// value beyond the bound (0: within). The tolerance is absolute, as the error is.
[[nodiscard]] ResultTable benchmark_table(const BenchmarkPlan& plan, const BenchmarkResults& results);
/// Makes the same table for readers; values that do not hold are marked.
[[nodiscard]] ResultTable benchmark_table_for_readers(const BenchmarkPlan& plan, const BenchmarkResults& results,
                                                      bool with_published);
/// Returns sentences such as "280 of 283 expected values hold; not done: …".
[[nodiscard]] std::vector<std::string> benchmark_notes(const BenchmarkPlan& plan, const BenchmarkResults& results);

/// Writes benchmark.csv and benchmark.md; for scorecards also scorecard.csv and scorecard.md.
void write_benchmark_tables(const BenchmarkPlan& plan, const BenchmarkResults& results);

}  // namespace ricochet
