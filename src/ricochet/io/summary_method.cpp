#include "ricochet/io/summary_method.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace ricochet {

namespace {

/// Other changes of the energy, with their columns.
constexpr std::array<std::pair<const char*, const char*>, 5> others{{{"friction", "friction_work"},
                                                                     {"damping", "damping_work"},
                                                                     {"supports", "support_work"},
                                                                     {"obstacles", "obstacle_work"},
                                                                     {"loads", "load_work"}}};

}  // namespace

Json energy_budget_to_json(const RunSummary& summary) {
  if (!summary.method_energy) return {};
  const double scale = summary.energy_scale();
  const auto part = [scale](double energy) { return Json::number(scale > 0.0 ? energy / scale : 0.0); };
  const MethodEnergy& method = *summary.method_energy;
  Json at_end = {{"method", Json::number(method.at_end)}};
  for (const auto& [name, column] : others) at_end[name] = part(summary.digest(column).last);
  const auto& columns = summary.columns;
  if (std::find(columns.begin(), columns.end(), "viscous_dissipation") != columns.end())
    at_end["relaxation"] = part(-summary.digest("viscous_dissipation").last);
  return {{"largest_energy", Json::number(scale)},
          {"lost_by_method", Json::number(method.lost)},
          {"created_by_method", Json::number(method.created)},
          {"at_end", at_end}};
}

Json reactions_to_json(const RunSummary& summary) {
  if (!summary.reactions) return {};
  const ActingReactions& acting = *summary.reactions;
  const bool any = acting.mean_steps > 0;
  return {{"acting", acting.kind},
          {"least_end_weight", any ? Json::number(acting.least_weight) : Json()},
          {"largest_end_weight", any ? Json::number(acting.largest_weight) : Json()},
          {"steps_of_means", acting.mean_steps},
          {"steps_without_mean", acting.end_steps}};
}

Json adaptive_steps_to_json(const RunSummary& summary) {
  if (!summary.adaptive) return {};
  const StepCounts& counts = summary.adaptive->counts;
  return {{"tolerance", summary.adaptive->tolerance},
          {"time", summary.adaptive->time},
          {"shortest", counts.shortest},
          {"longest", counts.longest},
          {"refused", counts.refused},
          {"unsolved", counts.unsolved},
          {"above_tolerance", counts.tolerated},
          {"largest_error", Json::number(counts.largest_error)}};
}

namespace {

void read_adaptive_steps(const Json& json, RunSummary& summary) {
  if (!json.contains("adaptive_steps") || !json.at("adaptive_steps").is_object()) return;
  const Json& steps = json.at("adaptive_steps");
  AdaptiveSteps read{.tolerance = steps.at("tolerance"), .time = steps.at("time")};
  read.counts = {.refused = steps.at("refused"),
                 .unsolved = steps.at("unsolved"),
                 .tolerated = steps.at("above_tolerance"),
                 .largest_error = steps.at("largest_error").to_number(),
                 .shortest = steps.at("shortest"),
                 .longest = steps.at("longest")};
  summary.adaptive = read;
}

}  // namespace

Json processes_to_json(const RunSummary& summary) {
  if (!summary.processes) return {};
  const ProcessReport& p = *summary.processes;
  return {{"count", p.count},
          {"least_dofs", p.least_dofs},
          {"most_dofs", p.most_dofs},
          {"messages_per_step", p.messages_per_step},
          {"bytes_per_step", p.bytes_per_step},
          {"reductions_per_step", p.reductions_per_step}};
}

Json iterations_to_json(const RunSummary& summary) {
  if (!summary.iterations) return {};
  return {{"rounds_per_step", summary.iterations->schwarz_iterations_per_step},
          {"gradients_per_step", summary.iterations->gradients_per_step}};
}

Json unsettled_contacts_to_json(const RunSummary& summary) {
  Json result = Json::array();
  for (const UnsettledContact& contact : summary.unsettled) {
    Json coordinates = Json::array();
    for (const double coordinate : contact.position) coordinates.push_back(Json::number(coordinate));
    result.push_back({{"contact", contact.contact},
                      {"share_of_force", Json::number(contact.share)},
                      {"steps", contact.steps},
                      {"first_time", Json::number(contact.first_time)},
                      {"time", Json::number(contact.time)},
                      {"gap", Json::number(contact.gap)},
                      {"place", coordinates}});
  }
  return result;
}

namespace {

UnsettledContact unsettled_from(const Json& json) {
  std::vector<double> coordinates;
  for (const Json& coordinate : json.at("place")) coordinates.push_back(coordinate.to_number());
  return {json.at("contact"),
          json.at("share_of_force").to_number(),
          json.at("steps"),
          json.at("first_time").to_number(),
          json.at("time").to_number(),
          json.at("gap").to_number(),
          coordinates};
}

}  // namespace

void read_method(const Json& json, RunSummary& summary) {
  for (const Json& contact : json.value("unsettled_contacts", Json::array()))
    summary.unsettled.push_back(unsettled_from(contact));
  if (const Json processes = json.value("processes", Json()); processes.is_object()) {
    summary.processes = ProcessReport{processes.at("count"),          processes.at("least_dofs"),
                                      processes.at("most_dofs"),      processes.at("messages_per_step"),
                                      processes.at("bytes_per_step"), processes.at("reductions_per_step")};
  }
  if (const Json iterations = json.value("iterations", Json()); iterations.is_object())
    summary.iterations = IterationReport{iterations.at("rounds_per_step"), iterations.at("gradients_per_step")};
  read_adaptive_steps(json, summary);
  if (json.contains("energy_budget") && json.at("energy_budget").is_object()) {
    const Json& budget = json.at("energy_budget");
    summary.method_energy =
        MethodEnergy{budget.at("lost_by_method").to_number(), budget.at("created_by_method").to_number(),
                     budget.at("at_end").at("method").to_number()};
  }
  if (!json.contains("reactions") || !json.at("reactions").is_object()) return;
  const Json& reactions = json.at("reactions");
  ActingReactions acting;
  acting.kind = reactions.at("acting");
  acting.mean_steps = reactions.at("steps_of_means");
  acting.end_steps = reactions.at("steps_without_mean");
  if (acting.mean_steps > 0) {
    acting.least_weight = reactions.at("least_end_weight").to_number();
    acting.largest_weight = reactions.at("largest_end_weight").to_number();
  }
  summary.reactions = acting;
}

}  // namespace ricochet
