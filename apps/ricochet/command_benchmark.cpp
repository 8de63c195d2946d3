#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "commands.hpp"
#include "installed_files.hpp"
#include "ricochet/base/child_processes.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/study/benchmark/benchmark.hpp"
#include "ricochet/study/benchmark/scorecard.hpp"
#include "stop_signal.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;

/// Returns benchmarks.toml of the requested folder, or the one installed with the program.
std::string manifest_file(const std::string& folder) {
  if (!folder.empty()) {
    const std::string path = (fs::path(folder) / "benchmarks.toml").string();
    if (fs::is_regular_file(path)) return path;
    throw Error(ErrorKind::file_access,
                fmt::format("--folder {}: this folder has no benchmarks.toml, the list of benchmarks", folder));
  }
  return benchmark_manifest();
}

void list_benchmarks(const std::vector<Benchmark>& benchmarks) {
  ResultTable table{{{"name"}, {"group"}, {"description"}}, {}, 1};
  for (const Benchmark& b : benchmarks) table.rows.push_back({b.name, b.group, b.description});
  fmt::print("{}", to_aligned_text(table));
}

void print_benchmarks(const BenchmarkPlan& plan, const BenchmarkResults& results) {
  if (plan.is_scorecard) {
    fmt::print("{}", scorecard_in_aligned_text(plan, results));
  } else {
    fmt::print("{}", to_aligned_text(benchmark_table_for_readers(plan, results, false)));
  }
  for (const std::string& note : benchmark_notes(plan, results)) fmt::print("  {}\n", note);
  fmt::print("{}; {}/benchmark.csv, benchmark.md{}\n", counted(plan.runs.size(), "benchmark run"), plan.directory,
             plan.is_scorecard ? ", scorecard.csv, scorecard.md" : "");
}

}  // namespace

void describe_benchmarks(const std::string& directory) {
  const BenchmarkPlan plan = read_benchmark_plan(directory);
  print_benchmarks(plan, read_benchmark_results(plan));
}

int benchmark(const BenchmarkArguments& arguments) {
  const std::vector<Benchmark> all = read_benchmarks(manifest_file(arguments.folder));
  if (arguments.list) {
    list_benchmarks(choose_benchmarks(all, arguments.names));
    return 0;
  }
  const std::vector<Benchmark> chosen = choose_benchmarks(all, arguments.names);
  BenchmarkOptions options;
  options.pool.jobs = arguments.jobs > 0 ? std::size_t(arguments.jobs) : usable_cores();
  options.pool.quiet = arguments.quiet;
  options.pool.stop_signal = stop_signal;
  options.resume = arguments.resume;
  options.force = arguments.force;
  const BenchmarkPlan plan = arguments.scheme.empty()
                                 ? plan_benchmarks(chosen, arguments.output_directory)
                                 : plan_scorecard(chosen, parse_methods(arguments.scheme), arguments.scheme == "all",
                                                  arguments.output_directory);
  int signal = 0;
  const BenchmarkResults results = conduct_benchmarks(plan, options, signal);
  print_benchmarks(plan, results);
  if (signal == 0) return results.worst_status;
  fmt::print("  stopped; the same command with --resume continues\n");
  return 128 + signal;
}

}  // namespace ricochet::program
