#include "ricochet/io/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "ricochet/base/error.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/cell_rotations.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/io/summary_expectations.hpp"
#include "ricochet/io/summary_method.hpp"
#include "ricochet/io/summary_results.hpp"
#include "ricochet/simulation/history/history_columns.hpp"

namespace ricochet {

namespace {

Json extrema_to_json(const RunSummary& summary) {
  Json result = Json::object();
  for (std::size_t i = 0; i < summary.digests.size() && i < summary.columns.size(); ++i) {
    const ColumnDigest& digest = summary.digests[i];
    result[summary.columns[i]] = {{"first", Json::number(digest.first)},
                                  {"last", Json::number(digest.last)},
                                  {"minimum", Json::number(digest.minimum)},
                                  {"maximum", Json::number(digest.maximum)},
                                  {"total_variation", Json::number(digest.total_variation)}};
  }
  return result;
}

Json probes_to_json(const RunSummary& summary) {
  Json result = Json::array();
  for (std::size_t i = 0; i < summary.probes.size(); ++i) {
    const Probe& probe = summary.probes[i];
    result.push_back({{"name", probe.name},
                      {"node", probe.node},
                      {"position", summary.probe_positions[i]},
                      {"distance", probe.distance},
                      {"in_contact_boundary", probe.contact_node >= 0}});
  }
  return result;
}

Json probe_sums_to_json(const RunSummary& summary) {
  Json result = Json::array();
  for (const auto& [name, sums] : summary.probe_sums) result.push_back({{"name", name}, {"sums", sums}});
  return result;
}

Json contacts_to_json(const RunSummary& summary) {
  Json result = Json::array();
  for (const ContactDescription& c : summary.contacts) {
    Json entry = {{"group", c.group},
                  {c.between_bodies ? "against" : "obstacle", c.opponent},
                  {"multipliers", c.multipliers},
                  {"friction", c.friction},
                  {"friction_bound", c.friction_bound},
                  {"obstacle_velocity", c.obstacle_velocity},
                  {"obstacle_rotation_rate", c.obstacle_rotation_rate}};
    if (c.between_bodies) entry["tied"] = c.tied;
    if (!c.all_pairs_group.empty()) entry["pair_of"] = c.all_pairs_group;
    if (c.obstacle_moves_freely) entry["obstacle_moves_freely"] = true;
    if (c.facing) {
      entry["facing"] = {{"multipliers_on", c.facing->multipliers_on},
                         {"reason", c.facing->reason},
                         {"contact_points", c.facing->points},
                         {"covered", Json::number(c.facing->covered)},
                         {"smallest_gap", Json::number(c.facing->smallest_gap)},
                         {"largest_gap", Json::number(c.facing->largest_gap)}};
    }
    result.push_back(std::move(entry));
  }
  return result;
}

std::optional<PairingDescription> facing_from(const Json& contact) {
  if (!contact.contains("facing")) return {};
  const Json& facing = contact.at("facing");
  return PairingDescription{facing.at("multipliers_on"),           facing.at("reason"),
                            facing.at("contact_points"),           facing.at("covered").to_number(),
                            facing.at("smallest_gap").to_number(), facing.at("largest_gap").to_number()};
}

Json checks_to_json(const RunSummary& summary) {
  Json result = Json::object();
  for (const CheckResult& check : summary.checks)
    result[check.name] = {{"limit", Json::number(check.limit)}, {"largest", Json::number(check.largest)}};
  return result;
}

}  // namespace

std::string RunSummary::mass_text() const {
  return mass_built.empty() || mass_built == mass ? mass : fmt::format("{}, built as {}", mass, mass_built);
}

ColumnDigest RunSummary::digest(const std::string& column) const {
  const auto at = std::find(columns.begin(), columns.end(), column);
  const auto i = static_cast<std::size_t>(at - columns.begin());
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

/// Parses "t +0.5 time_step".
double instant_from(const std::string& text, const std::string& path) {
  double steps = 0.0;
  if (std::sscanf(text.c_str(), "t %lf time_step", &steps) != 1)
    throw Error(ErrorKind::invalid_input, fmt::format("{}: instants: \"{}\" is not an instant", path, text));
  return steps;
}

}  // namespace

double RunSummary::part_done() const {
  if (status == "done") return 1.0;
  if (adaptive) return end_time > 0.0 ? std::clamp(adaptive->time / end_time, 0.0, 1.0) : 0.0;
  return all_steps > 0 ? std::clamp(static_cast<double>(steps) / static_cast<double>(all_steps), 0.0, 1.0) : 0.0;
}

double RunSummary::delay_of(const std::string& column) const {
  if (adaptive) return 0.0;  // values are offset by fractions of steps of different lengths
  if (column.ends_with("_energy") || column == "load_potential" || column.starts_with("momentum"))
    return energy_instant * step;
  const bool is_force = column.starts_with("contact_force") || column.starts_with("pair_force.") ||
                        column.find(".reaction") != std::string::npos || column.find(".pressure") != std::string::npos;
  return is_force ? force_instant * step : 0.0;
}

double RunSummary::energy_scale() const {
  return largest_size(*this, std::array<std::string, 3>{"total_energy", "kinetic_energy", "elastic_energy"});
}

double RunSummary::loss_by_method() const {
  if (method_energy) return method_energy->lost;
  const double scale = energy_scale();
  const double lost = digest("numerical_dissipation").maximum - std::min(0.0, digest("contact_work").minimum);
  return scale > 0.0 ? lost / scale : 0.0;
}

double RunSummary::creation_by_method() const {
  if (method_energy) return method_energy->created;
  const double scale = energy_scale();
  return scale > 0.0 ? digest("contact_work").maximum / scale : 0.0;
}

double RunSummary::deepest_penetration() const {
  double deepest = digest("max_penetration").maximum;
  for (const UnwatchedPenetration& found : penetration.found) deepest = std::max(deepest, found.depth);
  return deepest;
}

double RunSummary::work_scale() const {
  return largest_size(*this, column_names_of(ColumnGroup::work));
}

std::string to_json(const RunSummary& s) {
  Json timings = Json::object();
  for (const auto& [phase, seconds] : s.timings) timings[phase] = seconds;
  Json json = {{"status", s.status},
               {"message", s.message},
               {"steered_by_program", s.steered},
               {"title", s.title},
               {"case", s.case_file},
               {"overrides", s.overrides},
               {"case_path", s.case_path},
               {"settings", s.settings},
               {"ricochet_version", s.version},
               {"libraries", s.libraries},
               {"scheme", s.scheme},
               {"mass", s.mass},
               {"mass_built", s.mass_built},
               {"dimension", s.dimension},
               {"degree", s.degree},
               {"nodes", s.nodes},
               {"cells", s.cells},
               {"dofs", s.dofs},
               {"contact_points", s.contact_points},
               {"supported_dofs", s.supported_dofs},
               {"history_every", s.history_every},
               {"solver", s.solver},
               {"solver_reason", s.solver_reason},
               {"processes", processes_to_json(s)},
               {"iterations", iterations_to_json(s)},
               {"factor_entries", s.factor_entries},
               {"time_step", s.step},
               {"adaptive_steps", adaptive_steps_to_json(s)},
               {"end_time", s.end_time},
               {"critical_time_step", std::isfinite(s.critical_step) ? Json(s.critical_step) : Json()},
               {"critical_fraction", std::isfinite(s.critical_step) ? Json(s.step / s.critical_step) : Json()},
               {"steps", s.steps},
               {"steps_asked_for", s.all_steps},
               {"resumed_at", s.resumed_at},
               {"checkpoint_step", s.checkpoint_step >= 0 ? Json(s.checkpoint_step) : Json()},
               {"instants",
                {{"energy", fmt::format("t {:+g} time_step", s.energy_instant)},
                 {"force", fmt::format("t {:+g} time_step", s.force_instant)}}},
               {"frames", s.frames},
               {"timings_seconds", timings},
               {"seconds_per_step", s.time_per_step},
               {"processor_seconds", s.processor_seconds},
               {"peak_memory_bytes", s.peak_memory},
               {"energy_scale", Json::number(s.energy_scale())},
               {"energy_budget", energy_budget_to_json(s)},
               {"reactions", reactions_to_json(s)},
               {"unsettled_contacts", unsettled_contacts_to_json(s)},
               {"contacts", contacts_to_json(s)},
               {"probes", probes_to_json(s)},
               {"probe_sums", probe_sums_to_json(s)},
               {"extrema", extrema_to_json(s)},
               {"checks", checks_to_json(s)},
               {"warnings", s.warnings},
               {"expectations", expectations_to_json(s.expectations)},
               {"parameters", s.parameters}};
  json.update(summary_results_to_json(s));
  return json.dump(2) + "\n";
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

RunSummary read_summary(const std::string& path) {
  return summary_from_json(read_file(path), path);
}

RunSummary summary_from_json(const std::string& text, const std::string& path) {
  RunSummary s;
  try {
    const Json json = Json::parse(text);
    s.status = json.at("status");
    s.message = json.at("message");
    s.steered = json.value("steered_by_program", false);
    s.title = json.at("title");
    s.case_file = json.at("case");
    s.overrides = json.at("overrides").get<std::vector<std::string>>();
    s.case_path = json.value("case_path", "");
    s.settings = json.value("settings", std::vector<std::string>{});
    s.version = json.at("ricochet_version");
    s.scheme = json.at("scheme");
    s.mass = json.at("mass");
    s.mass_built = json.value("mass_built", "");
    s.dimension = json.at("dimension");
    s.degree = json.at("degree");
    s.nodes = json.at("nodes");
    s.cells = json.at("cells");
    s.dofs = json.at("dofs");
    s.contact_points = json.at("contact_points");
    s.history_every = json.value("history_every", 1L);
    s.solver = json.value("solver", "");
    s.solver_reason = json.value("solver_reason", "");
    s.step = json.at("time_step");
    s.end_time = json.at("end_time");
    const Json& critical = json.at("critical_time_step");
    if (critical.is_number()) s.critical_step = critical.get<double>();
    s.steps = json.at("steps");
    s.all_steps = json.value("steps_asked_for", s.steps);
    s.resumed_at = json.value("resumed_at", std::vector<long>{});
    s.libraries = json.value("libraries", "");
    s.parameters = json.value("parameters", std::map<std::string, std::string>{});
    if (json.contains("checkpoint_step") && json.at("checkpoint_step").is_number())
      s.checkpoint_step = json.at("checkpoint_step");
    s.frames = json.at("frames");
    s.energy_instant = instant_from(json.at("instants").at("energy"), path);
    s.force_instant = instant_from(json.at("instants").at("force"), path);
    s.time_per_step = json.at("seconds_per_step");
    s.processor_seconds = json.value("processor_seconds", 0.0);
    s.peak_memory = json.value("peak_memory_bytes", 0.0);
    s.warnings = json.at("warnings").get<std::vector<std::string>>();
    for (const auto& [phase, seconds] : json.at("timings_seconds").items()) s.timings.emplace_back(phase, seconds);
    const Json checks = json.value("checks", Json::object());
    for (const auto& [name, check] : checks.items())
      s.checks.push_back({name, check.at("limit").to_number(), check.at("largest").to_number()});
    s.expectations = read_expectations(json);
    read_method(json, s);
    read_summary_results(json, path, s);
    for (const auto& contact : json.at("contacts")) {
      const bool between_bodies = contact.contains("against");
      s.contacts.push_back({contact.at("group"), contact.at(between_bodies ? "against" : "obstacle"),
                            contact.at("multipliers"), contact.at("friction"), contact.at("friction_bound"),
                            contact.at("obstacle_velocity"), contact.at("obstacle_rotation_rate"), between_bodies,
                            contact.value("tied", Json(false)).get<bool>(), facing_from(contact),
                            contact.value("pair_of", std::string()),
                            contact.value("obstacle_moves_freely", Json(false)).get<bool>()});
    }
    for (const auto& probe : json.at("probes")) {
      s.probes.push_back({probe.at("name"), probe.at("node"), probe.at("distance"),
                          probe.at("in_contact_boundary").get<bool>() ? 0 : -1});
      s.probe_positions.push_back(probe.at("position"));
    }
    for (const auto& probe : json.value("probe_sums", Json::array()))
      s.probe_sums.emplace_back(probe.at("name").get<std::string>(), probe.at("sums").get<std::string>());
    for (const auto& [column, digest] : json.at("extrema").items()) {
      s.columns.push_back(column);
      s.digests.push_back({digest.at("first").to_number(), digest.at("last").to_number(),
                           digest.at("minimum").to_number(), digest.at("maximum").to_number(),
                           digest.at("total_variation").to_number()});
    }
  } catch (const Json::Exception& problem) {
    throw Error(ErrorKind::invalid_input, fmt::format("{}: not a summary of a run: {}", path, problem.what()));
  }
  return s;
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
