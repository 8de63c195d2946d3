#pragma once

#include <string>
#include <vector>

#include "ricochet/study/benchmark/manifest.hpp"

/// @file The directory of benchmarks that are run: benchmark.json, which says what they are, their runs in runs/, and
/// the tables.
namespace ricochet {

/// One benchmark with one method.
struct BenchmarkRun {
  Benchmark benchmark;
  std::string method;                 ///< as it was asked for; empty: that of the case
  std::string scheme, mass;           ///< no mass: the scheme takes none of those tried
  bool is_own_method = true;          ///< the scheme is that of the case
  std::vector<std::string> settings;  ///< "key.path=value"
  std::string folder;                 ///< its name in runs/
  std::string refusal;                ///< why it cannot be run; empty: it can

  bool operator==(const BenchmarkRun&) const;
};

struct BenchmarkPlan {
  std::string directory;
  bool is_scorecard = false;  ///< methods were asked for
  std::vector<BenchmarkRun> runs;

  [[nodiscard]] std::string path(const std::string& file) const;
  [[nodiscard]] std::string path(const BenchmarkRun& run) const;
};

[[nodiscard]] bool holds_benchmarks(const std::string& directory);
/// Throws Error(file_access) where there are none, Error(invalid_input) where benchmark.json is damaged.
[[nodiscard]] BenchmarkPlan read_benchmark_plan(const std::string& directory);
void write_benchmark_plan(const BenchmarkPlan& plan);

}  // namespace ricochet
