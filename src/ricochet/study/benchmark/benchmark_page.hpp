#pragma once

#include <string>

#include "ricochet/study/benchmark/benchmark_table.hpp"

/// @file The page of benchmarks: an HTML file with their tables.
namespace ricochet {

/// Links go to the runs as seen from `folder`, where the page is.
[[nodiscard]] std::string make_benchmark_page(const BenchmarkPlan& plan, const BenchmarkResults& results,
                                              const std::string& folder);

/// Is this file one that make_benchmark_page has made?
[[nodiscard]] bool is_benchmark_page(const std::string& path);

}  // namespace ricochet
