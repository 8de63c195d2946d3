#include "ricochet/study/benchmark/benchmark_files.hpp"

#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/study/run_folders.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

Json run_to_json(const BenchmarkRun& run) {
  return {{"name", run.benchmark.name},
          {"case", run.benchmark.case_path},
          {"group", run.benchmark.group},
          {"description", run.benchmark.description},
          {"method", run.method},
          {"scheme", run.scheme},
          {"mass", run.mass},
          {"own_method", run.is_own_method},
          {"settings", run.settings},
          {"folder", run.folder},
          {"refusal", run.refusal}};
}

BenchmarkRun run_from(const Json& json) {
  return {{json.at("name"), json.at("case"), json.at("group"), json.at("description")},
          json.at("method"),
          json.at("scheme"),
          json.at("mass"),
          json.at("own_method").get<bool>(),
          json.at("settings").get<std::vector<std::string>>(),
          json.at("folder"),
          json.at("refusal")};
}

}  // namespace

bool BenchmarkRun::operator==(const BenchmarkRun& other) const {
  return run_to_json(*this).dump() == run_to_json(other).dump();
}

BenchmarkPlan read_benchmark_plan(const std::string& directory) {
  BenchmarkPlan plan{{directory}, false, {}};
  if (!holds_benchmarks(directory))
    throw Error(ErrorKind::file_access, fmt::format("{}: holds no benchmarks: benchmark.json is missing", directory));
  read_plan(plan.path("benchmark.json"), "benchmarks", [&](const Json& json) {
    plan.is_scorecard = json.at("scorecard");
    for (const Json& run : json.at("runs")) {
      plan.runs.push_back(run_from(run));
      if (!is_run_folder_name(plan.runs.back().folder))
        throw Json::Exception(
            fmt::format("\"{}\" is not a valid name for the folder of a run", plan.runs.back().folder));
    }
  });
  return plan;
}

void write_benchmark_plan(const BenchmarkPlan& plan) {
  Json runs = Json::array();
  for (const BenchmarkRun& run : plan.runs) runs.push_back(run_to_json(run));
  const Json json{{version_attribute, version}, {"scorecard", plan.is_scorecard}, {"runs", runs}};
  write_durably(plan.path("benchmark.json"), json.dump(2) + "\n");
}

}  // namespace ricochet
