#include "ricochet/study/benchmark/benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "ricochet/base/error.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/run/run_identity.hpp"
#include "ricochet/study/run_folders.hpp"
#include "ricochet/study/run_state.hpp"
#include "ricochet/study/study_files.hpp"

namespace ricochet {

namespace {

/// Returns a name for a directory.
std::string folder_name(const std::string& benchmark, const std::string& method) {
  std::string name = benchmark + (method.empty() ? "" : "-" + method);
  std::ranges::replace(name, '/', '-');
  return name;
}

/// A method and, per benchmark, its choices.
struct MethodRow {
  RequestedMethod method;
  std::vector<MethodChoice> chosen;

  [[nodiscard]] bool is_always_refused() const {
    return std::ranges::all_of(chosen, [](const MethodChoice& c) { return c.is_refused(); });
  }
  /// Returns the mass that is chosen most often, or "".
  [[nodiscard]] std::string usual_mass() const;
};

std::string MethodRow::usual_mass() const {
  std::map<std::string, int> counts;
  for (const MethodChoice& c : chosen) counts[c.mass] += c.is_refused() ? 0 : 1;
  std::string usual;
  for (const auto& [mass, count] : counts) {
    if (count > 0 && (usual.empty() || count > counts[usual])) usual = mass;
  }
  return usual;
}

/// Returns the reason for a refusal that concerns the usual mass of the scheme; if there is none, any of the reasons.
std::string reason_of(const MethodChoice& chosen, const std::string& usual_mass) {
  const auto usual = chosen.refusals.find(usual_mass);
  return usual != chosen.refusals.end() ? usual->second : chosen.refusals.begin()->second;
}

bool lacks_contact_inertia(const std::string& mass) {
  return !mass.empty() && mass_registry().find(mass).type.removes_contact_inertia;
}

/// Inserts a row with the mass "consistent" after each row whose method states no mass and usually gets one without
/// inertia on contact nodes, unless the scheme never accepts it.
void add_consistent_rows(std::vector<MethodRow>& rows, std::vector<std::unique_ptr<MethodChooser>>& choosers) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].method.mass.empty() || !lacks_contact_inertia(rows[i].usual_mass())) continue;
    MethodRow row{{rows[i].method.scheme, "consistent"}, {}};
    for (const auto& chooser : choosers) row.chosen.push_back(chooser->choose(row.method));
    if (!row.is_always_refused()) rows.insert(rows.begin() + std::ptrdiff_t(i + 1), std::move(row));
  }
}

void refuse_existing_results(const std::string& directory, const BenchmarkOptions& options) {
  if (holds_run(directory) || holds_study(directory)) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: holds a {}; choose another directory for the benchmarks with -o", directory,
                            holds_study(directory) ? "study" : "run"));
  }
  if (!holds_benchmarks(directory) || options.resume || options.force) return;
  throw Error(ErrorKind::file_access,
              fmt::format("{}: already contains benchmarks; keep the completed runs with --resume, choose another "
                          "directory with -o, or overwrite the benchmarks with --force",
                          directory));
}

/// Removes runs that cannot be kept: those of other plans, and of cases that have changed since.
void remove_old_runs(const BenchmarkPlan& plan, const BenchmarkOptions& options) {
  if (!holds_benchmarks(plan.directory)) return;
  const auto is_kept = [&](const BenchmarkRun& old) {
    if (!options.resume || std::ranges::find(plan.runs, old) == plan.runs.end()) return false;
    try {
      const RunState state = read_run_state(plan.path(old));
      warn_of_other_version(state);
      if (!state.summary) return false;
      require_same_case(read_case(old.benchmark.case_path, old.settings), state.summary->version,
                        state.summary->parameters, plan.path(old));
    } catch (const Error&) {
      return false;
    }
    return true;
  };
  std::vector<std::string> folders;
  for (const BenchmarkRun& old : read_benchmark_plan(plan.directory).runs) {
    if (!is_kept(old)) folders.push_back(old.folder);
  }
  remove_run_folders(plan.directory, folders);
}

int run_benchmarks(const BenchmarkPlan& plan, const RunPoolOptions& options) {
  std::vector<PooledRun> runs;
  for (const BenchmarkRun& run : plan.runs) {
    if (run.refusal.empty()) runs.push_back({run.benchmark.case_path, run.settings, plan.path(run)});
  }
  return run_pool(runs, options, [&] {
    for (const char* file : {"benchmark.csv", "benchmark.md", "scorecard.csv", "scorecard.md"}) {
      std::error_code ignored;
      std::filesystem::remove(plan.path(file), ignored);
    }
  });
}

}  // namespace

BenchmarkPlan plan_benchmarks(const std::vector<Benchmark>& benchmarks, const std::string& directory) {
  BenchmarkPlan plan{{directory}, false, {}};
  for (const Benchmark& benchmark : benchmarks) {
    BenchmarkRun& run = plan.runs.emplace_back();
    run.benchmark = benchmark;
    run.folder = benchmark.name;
    try {
      const Case input = read_case(benchmark.case_path);
      run.scheme = input.time.scheme;
      run.mass = input.mass.type;
    } catch (const Error& problem) {
      run.refusal = problem.what();
    }
  }
  return plan;
}

BenchmarkPlan plan_scorecard(const std::vector<Benchmark>& benchmarks, const std::vector<RequestedMethod>& methods,
                             bool also_consistent, const std::string& directory) {
  std::vector<MethodRow> rows;
  for (const RequestedMethod& method : methods) rows.push_back({method, {}});
  std::vector<std::unique_ptr<MethodChooser>> choosers;
  for (const Benchmark& benchmark : benchmarks) {
    choosers.push_back(std::make_unique<MethodChooser>(benchmark.case_path));
    for (MethodRow& row : rows) row.chosen.push_back(choosers.back()->choose(row.method));
  }
  if (also_consistent) add_consistent_rows(rows, choosers);
  BenchmarkPlan plan{{directory}, true, {}};
  for (const MethodRow& row : rows) {
    for (std::size_t b = 0; b < benchmarks.size(); ++b) {
      BenchmarkRun& run = plan.runs.emplace_back();
      run.benchmark = benchmarks[b];
      run.method = row.method.text();
      run.scheme = row.method.scheme;
      run.mass = row.chosen[b].mass;
      run.is_own_method = run.scheme == choosers[b]->scheme_of_case();
      run.settings = row.chosen[b].settings;
      run.folder = folder_name(benchmarks[b].name, run.method);
      if (row.chosen[b].is_refused()) run.refusal = reason_of(row.chosen[b], row.usual_mass());
    }
  }
  return plan;
}

BenchmarkResults conduct_benchmarks(const BenchmarkPlan& plan, const BenchmarkOptions& options, int& signal) {
  refuse_existing_results(plan.directory, options);
  const RunDirectory lock(plan.directory);
  remove_old_runs(plan, options);
  write_benchmark_plan(plan);
  signal = run_benchmarks(plan, options.pool);
  BenchmarkResults results = read_benchmark_results(plan);
  write_benchmark_tables(plan, results);
  return results;
}

}  // namespace ricochet
