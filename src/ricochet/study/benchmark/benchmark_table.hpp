#pragma once

#include <string>
#include <vector>

#include "ricochet/io/summary.hpp"
#include "ricochet/study/benchmark/benchmark_files.hpp"
#include "ricochet/study/run_state.hpp"
#include "ricochet/study/table.hpp"

/// @file What came out of benchmarks: a row for each reference value.
namespace ricochet {

/// Of one benchmark with one method.
struct BenchmarkOutcome {
  RunState state;
  std::vector<ExpectationResult> expectations;  ///< those that apply; of a run that is not done none of them holds
  std::string message;                          ///< why it is not done, or ""

  [[nodiscard]] std::size_t applies() const { return expectations.size(); }
  [[nodiscard]] std::size_t holds() const;
  /// "done", "refused", "failed at t = 0.5", "interrupted" or "not run".
  [[nodiscard]] std::string word() const;
};

struct BenchmarkResults {
  std::vector<BenchmarkOutcome> outcomes;  ///< in the order of the plan's runs
  int worst_status = 0;  ///< 0 all hold; 5 some do not; or that of the run that went worst. What another scheme than
                         ///< that of the case refuses does not count.
};

/// Reads all runs, as far as they are, and evaluates the [[expect]] entries of their cases that apply to them, whatever
/// was set.
[[nodiscard]] BenchmarkResults read_benchmark_results(const BenchmarkPlan& plan);

/// For programs: case, quantity, reference, value, error, tolerance, published, scheme, mass, holds. The reference is
/// a number, or bounds ("≤ 1"); the error is value − reference, and of bounds how far the value is beyond the bound
/// (0: within). The tolerance is absolute, as the error is.
[[nodiscard]] ResultTable benchmark_table(const BenchmarkPlan& plan, const BenchmarkResults& results);
/// The same for readers, with what does not hold marked.
[[nodiscard]] ResultTable benchmark_table_for_readers(const BenchmarkPlan& plan, const BenchmarkResults& results,
                                                      bool with_published);
/// "280 of 283 expected values hold; not done: …": sentences.
[[nodiscard]] std::vector<std::string> benchmark_notes(const BenchmarkPlan& plan, const BenchmarkResults& results);

/// Writes benchmark.csv and benchmark.md; of scorecards scorecard.csv and scorecard.md, too.
void write_benchmark_tables(const BenchmarkPlan& plan, const BenchmarkResults& results);

}  // namespace ricochet
