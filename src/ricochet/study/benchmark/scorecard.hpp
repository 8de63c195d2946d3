#pragma once

#include <string>
#include <vector>

#include "ricochet/study/benchmark/benchmark_table.hpp"

/// @file Methods against benchmarks: how many reference values each reproduces.
namespace ricochet {

/// Makes the table for programs, with a row for each method and benchmark: scheme, mass, benchmark, holds, applies,
/// created_percent, lost_percent (of the largest energy), status, processor_seconds, steps, time_step, message.
[[nodiscard]] ResultTable scorecard_table(const BenchmarkPlan& plan, const BenchmarkResults& results);

/// A part of the matrix for readers: a row for each method, a column for each benchmark of a group.
struct ScorecardPart {
  std::string title;  ///< the group; may be empty
  ResultTable table;
};
struct ScorecardMatrix {
  ResultTable totals;  ///< a row for each method: sums over all benchmarks
  std::vector<ScorecardPart> parts;
  std::vector<std::string> reasons;  ///< of refusals, numbered from 1 as in the cells
};
[[nodiscard]] ScorecardMatrix scorecard_matrix(const BenchmarkPlan& plan, const BenchmarkResults& results);

/// Returns the whole matrix, without a heading.
[[nodiscard]] std::string scorecard_in_markdown(const BenchmarkPlan& plan, const BenchmarkResults& results);
[[nodiscard]] std::string scorecard_in_aligned_text(const BenchmarkPlan& plan, const BenchmarkResults& results);

}  // namespace ricochet
