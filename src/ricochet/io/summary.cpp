#include "ricochet/io/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/io/summary_visitor.hpp"
#include "ricochet/simulation/history/history_columns.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"

namespace ricochet {

std::string RunSummary::mass_text() const {
  return mass_built.empty() || mass_built == mass ? mass : fmt::format("{}, built as {}", mass, mass_built);
}

ColumnDigest RunSummary::digest(const std::string& column) const {
  const auto at = std::ranges::find(columns, column);
  const auto i = std::size_t(at - columns.begin());
  return i < digests.size() ? digests[i] : ColumnDigest{};
}

namespace {

template <class Columns>
double largest_size(const RunSummary& summary, const Columns& columns) {
  double largest = 0.0;
  for (const std::string& column : columns) {
    const ColumnDigest digested = summary.digest(column);
    largest = std::max({largest, std::abs(digested.minimum), std::abs(digested.maximum)});
  }
  return largest;
}

}  // namespace

double RunSummary::part_done() const {
  if (status == "done") return 1.0;
  if (adaptive) return end_time > 0.0 ? std::clamp(adaptive->time / end_time, 0.0, 1.0) : 0.0;
  return all_steps > 0 ? std::clamp(double(steps) / double(all_steps), 0.0, 1.0) : 0.0;
}

double RunSummary::delay_of(const std::string& column) const {
  if (adaptive) return 0.0;  // values are offset by fractions of steps of different lengths
  // Names of probes and bodies may be any; what follows them is the quantity.
  const std::size_t dot = column.rfind('.');
  const std::string quantity = dot == std::string::npos ? column : column.substr(dot);
  const auto begins_quantity = [&quantity](const char* name) { return quantity.starts_with(name); };
  constexpr std::array momenta{"momentum_", "angular_momentum_"};
  if (quantity.ends_with("_energy") || quantity == "load_potential" || std::ranges::any_of(momenta, begins_quantity) ||
      column.starts_with("momentum."))
    return energy_instant * step;
  constexpr std::array forces{"contact_force_", ".contact_force_", ".reaction_", ".pressure", ".nominal_pressure"};
  const bool is_force = column.starts_with("pair_force.") || std::ranges::any_of(forces, begins_quantity);
  return is_force ? force_instant * step : 0.0;
}

const Impact* RunSummary::first_restitution() const {
  const auto found =
      std::ranges::find_if(impacts, [](const Impact& impact) { return impact.restitution().has_value(); });
  return found != impacts.end() ? &*found : nullptr;
}

const Impact* RunSummary::hardest_impact() const {
  const auto found = std::ranges::max_element(impacts, {}, &Impact::largest_force);
  return found != impacts.end() ? &*found : nullptr;
}

double RunSummary::energy_scale() const {
  return largest_size(*this, std::array<std::string, 3>{"total_energy", "kinetic_energy", "elastic_energy"});
}

double RunSummary::deepest_penetration() const {
  double deepest = digest("max_penetration").maximum;
  for (const UnwatchedPenetration& found : penetration.found) deepest = std::max(deepest, found.depth);
  return deepest;
}

double RunSummary::work_scale() const { return largest_size(*this, column_names_of(ColumnGroup::work)); }

bool RunSummary::small_strain_holds_in(std::size_t impact) const {
  return rotation.holds_in_impact(impact) && !(impact < impacts.size() && is_distorted_by_rotation(impacts[impact]));
}

bool RunSummary::cells_turn_little_in_impacts() const {
  if (impacts.empty() || impacts_left_out > 0) return digest("max_rotation").maximum <= rotation.limit;
  for (std::size_t i = 0; i < impacts.size(); ++i) {
    if (!rotation.holds_in_impact(i)) return false;
  }
  return true;
}

bool RunSummary::small_strain_holds_in_impacts() const {
  return cells_turn_little_in_impacts() && std::ranges::none_of(impacts, is_distorted_by_rotation);
}

std::string to_json(const RunSummary& summary) {
  Json json = Json::object();
  RunSummary written = summary;
  SummaryVisitor visit(SummaryVisitor::Task::write, written, json);
  describe(visit, written);
  return json.dump(2) + "\n";
}

std::string summary_schema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"$comment", "Numbers that are infinite or NaN are the words \"inf\", \"-inf\" and \"nan\"."}};
  RunSummary sample;
  SummaryVisitor visit(SummaryVisitor::Task::outline, sample, schema);
  describe(visit, sample);
  return schema.dump(2) + "\n";
}

void write_summary(const std::string& path, const RunSummary& summary) {
  const std::string temporary = path + ".new";
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file << to_json(summary);
  file.close();
  std::error_code problem;
  if (file) std::filesystem::rename(temporary, path, problem);
  if (!file || problem)
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot write: {}", path, std::strerror(errno)));
}

std::string summary_text_of_run(const std::string& directory) {
  if (!holds_run(directory)) {
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: this directory holds no run: it has neither summary.json nor a checkpoint", directory));
  }
  const std::string path = (std::filesystem::path(directory) / "summary.json").string();
  if (std::error_code ignored; !std::filesystem::exists(path, ignored)) {
    throw Error(ErrorKind::file_access,
                fmt::format("{0}: summary.json is missing, but the run in this directory has left a checkpoint: "
                            "`ricochet run` with --resume continues the run and writes a summary",
                            directory));
  }
  return read_file(path);
}

RunSummary read_summary_of_run(const std::string& directory) {
  const std::string text = summary_text_of_run(directory);
  return summary_from_json(text, (std::filesystem::path(directory) / "summary.json").string());
}

std::optional<RunSummary> find_intact_summary(const std::string& directory) {
  try {
    return read_summary((std::filesystem::path(directory) / "summary.json").string());
  } catch (const VersionError&) {
    throw;
  } catch (const Error&) {
    return std::nullopt;
  }
}

RunSummary read_summary(const std::string& path) { return summary_from_json(read_file(path), path); }

RunSummary summary_from_json(const std::string& text, const std::string& path) {
  try {
    Json json = Json::parse(text);
    require_readable_version(path, json.at(version_attribute));
    RunSummary summary;
    SummaryVisitor visit(SummaryVisitor::Task::read, summary, json);
    describe(visit, summary);
    return summary;
  } catch (const Json::Exception& problem) {
    throw Error(ErrorKind::invalid_input, fmt::format("{}: not a summary of a run: {}", path, problem.what()));
  }
}

namespace {

/// Returns whether there is an entry of this name, or of this number from 0.
bool contains(const Json& json, const std::string& key) {
  if (json.is_object()) return json.contains(key);
  return json.is_array() && is_digits(key, 1, 9) && std::stoul(key) < json.size();
}

}  // namespace

double summary_value(const std::string& json_text, const std::string& path) {
  Json json = Json::parse(json_text);
  // Column names contain dots ("lowest.gap"), so the longest matching key is used at each level.
  const Json* at = &json;
  std::string rest = path;
  while (!rest.empty()) {
    std::string key = rest;
    while (!contains(*at, key)) {
      const std::size_t dot = key.rfind('.');
      if (dot == std::string::npos) {
        throw Error(ErrorKind::invalid_input,
                    fmt::format("summary.{}: there is no entry \"{}\" in summary.json", path, rest));
      }
      key.resize(dot);
    }
    at = at->is_array() ? &at->at(std::stoul(key)) : &at->at(key);
    rest = rest.size() > key.size() ? rest.substr(key.size() + 1) : "";
  }
  if (!at->is_number()) throw Error(ErrorKind::invalid_input, fmt::format("summary.{} is not a number", path));
  return at->get<double>();
}

}  // namespace ricochet
