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
  bool resume = false;  ///< keep completed runs
  bool force = false;   ///< replace existing benchmarks
};

/// Plans every benchmark with the method of its case.
[[nodiscard]] BenchmarkPlan plan_benchmarks(const std::vector<Benchmark>& benchmarks, const std::string& directory);
/// Plans every benchmark with every method. This takes a while, as meshes are read and models are built. If
/// `also_consistent` is set, a scheme given without a mass that gets one without inertia on contact nodes has a second
/// row with the mass "consistent", if it accepts that.
[[nodiscard]] BenchmarkPlan plan_scorecard(const std::vector<Benchmark>& benchmarks,
                                           const std::vector<RequestedMethod>& methods, bool also_consistent,
                                           const std::string& directory);

/// Computes the runs that are not complete and writes the tables; `signal` receives the signal that has stopped it, or
/// 0. Throws Error(file_access) if the directory holds something else, or benchmarks without an option that says how to
/// treat them.
[[nodiscard]] BenchmarkResults conduct_benchmarks(const BenchmarkPlan& plan, const BenchmarkOptions& options,
                                                  int& signal);

}  // namespace ricochet
