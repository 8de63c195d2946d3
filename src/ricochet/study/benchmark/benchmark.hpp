#pragma once

#include <string>
#include <vector>

#include "ricochet/study/benchmark/benchmark_files.hpp"
#include "ricochet/study/benchmark/benchmark_table.hpp"
#include "ricochet/study/benchmark/methods.hpp"
#include "ricochet/study/run_pool.hpp"

/// @file Benchmarks: cases with reference values, run one by one with their own method, or each with many.
namespace ricochet {

struct BenchmarkOptions {
  RunPoolOptions pool = {};
  bool resume = false;  ///< keep the runs that are there and done
  bool force = false;   ///< start anew over benchmarks that are there
};

/// Every benchmark as its case has it.
[[nodiscard]] BenchmarkPlan plan_benchmarks(const std::vector<Benchmark>& benchmarks, const std::string& directory);
/// Every benchmark with every method, which takes a while: meshes are read and models are built. A scheme without a
/// mass that takes one without inertia on contact nodes gets a second line with the mass "consistent", where
/// `also_consistent` asks for that and it takes it.
[[nodiscard]] BenchmarkPlan plan_scorecard(const std::vector<Benchmark>& benchmarks,
                                           const std::vector<AskedMethod>& methods, bool also_consistent,
                                           const std::string& directory);

/// Runs what is still to be run and writes the tables; `signal` gets what has stopped it, or 0. Throws
/// Error(file_access) where the directory holds something else, or benchmarks, and nothing says what to do with them.
[[nodiscard]] BenchmarkResults conduct_benchmarks(const BenchmarkPlan& plan, const BenchmarkOptions& options,
                                                  int& signal);

}  // namespace ricochet
