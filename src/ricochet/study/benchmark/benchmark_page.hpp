#pragma once

#include <string>

#include "ricochet/study/benchmark/benchmark_table.hpp"

/// @file The page of benchmarks: an HTML file with their tables.
namespace ricochet {

/// Makes the page. Links to the runs are relative to `folder`, which contains the page.
[[nodiscard]] std::string make_benchmark_page(const BenchmarkPlan& plan, const BenchmarkResults& results,
                                              const std::string& folder);

/// Returns true if make_benchmark_page has made this file.
[[nodiscard]] bool is_benchmark_page(const std::string& path);

}  // namespace ricochet
