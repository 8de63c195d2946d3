#pragma once

#include <string>
#include <vector>

#include "ricochet/study/benchmark/manifest.hpp"
#include "ricochet/study/run_folders.hpp"

/// @file The directory of benchmarks: benchmark.json with their plan, their runs in runs/, and the tables.
namespace ricochet {

/// Run of one benchmark with one method.
struct BenchmarkRun {
  Benchmark benchmark;
  std::string method;                 ///< as requested; empty: the method of the case
  std::string scheme, mass;           ///< no mass if the scheme accepts none of those tried
  bool is_own_method = true;          ///< the scheme is that of the case
  std::vector<std::string> settings;  ///< "key.path=value"
  std::string folder;                 ///< name of its folder in runs/
  std::string refusal;                ///< reason why it cannot be run; empty if it can

  bool operator==(const BenchmarkRun&) const;
};

struct BenchmarkPlan : PlanDirectory {
  bool is_scorecard = false;  ///< methods were requested
  std::vector<BenchmarkRun> runs;
};

[[nodiscard]] inline bool holds_benchmarks(const std::string& directory) {
  return holds_plan(directory, "benchmark.json");
}
/// Throws Error(file_access) if there are no benchmarks, Error(invalid_input) if benchmark.json is damaged.
[[nodiscard]] BenchmarkPlan read_benchmark_plan(const std::string& directory);
void write_benchmark_plan(const BenchmarkPlan& plan);

}  // namespace ricochet
