#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "ricochet/base/text.hpp"
#include "ricochet/case/keys.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Probes of the case: nodes, boundaries, groups and contacts that are watched, and their sensors.
namespace ricochet {

namespace {

/// Number of bodies above which their momenta have no columns: history.csv would consist of little else.
constexpr int most_bodies = 20;
/// Number of pairs of one [[contact]] above which their forces have no columns.
constexpr std::size_t most_pairs = 20;

ProbeContext setting_of(const Case& input, const Model& model, std::size_t number) {
  const auto path = [number](const std::string& key) { return fmt::format("probe.{}.{}", number, key); };
  const ProbeSection& section = input.probes[number];
  ProbeContext setting{
      .name = section.name,
      .values = section.values,
      .body = model.body,
      .problem = model.problem,
      .bodies = model.bodies,
      .pairs = model.contact_pairs,
      .entry_of_pair = {},
      .entry_is_tied = {},
      .refuse = [&input, path](const std::string& key, const std::string& text) { refuse(input, path(key), text); },
      .group = [&input, &model, &section, path](const std::string& key, int dimension) -> const Group& {
        return group_at(input, path(key), model.mesh, section.values.text(key), dimension);
      },
      .boundary =
          [&input, &model, &section, path](const std::string& key) {
            return boundary_at(input, path(key), model.mesh, section.values.text(key));
          }};
  for (const ModelContact& contact : model.contacts) setting.entry_of_pair.push_back(contact.entry);
  for (const ContactSection& contact : input.contacts) setting.entry_is_tied.push_back(contact.tied);
  return setting;
}

/// Returns the label of a body in names of columns: its name if it is a plain one, else its number. Tied parts are
/// named after the first one.
std::string label_of(const std::string& name, int number) {
  const std::optional<std::string_view> inner = between(name, "body \"", "\"");
  return inner && is_plain_name(*inner) ? std::string(*inner) : std::to_string(number);
}

HistoryBodies bodies_of_history(const Model& model) {
  const ConnectedBodies& bodies = model.bodies.connected;
  if (bodies.count < 2 || bodies.count > most_bodies) return {};
  HistoryBodies result;
  const std::vector<std::string>& names = model.bodies.names;
  std::set<std::string> used_names;
  for (const MeshPart& part : model.mesh.parts) used_names.insert(part.name);
  for (int body = 0; body < bodies.count; ++body) {
    std::string label = label_of(names[std::size_t(body)], body);
    // The name of a part may be a number; no other body may then use it.
    if (label == std::to_string(body) && used_names.contains(label)) label = "body_" + label;
    while (std::ranges::find(result.labels, label) != result.labels.end()) label += "_";
    result.labels.push_back(std::move(label));
  }
  result.of_node = bodies.of_node;
  return result;
}

/// Returns the number of pairs of the same [[contact]].
std::size_t count_of_entry(const Model& model, std::size_t number) {
  return std::size_t(std::ranges::count_if(
      model.contacts, [&](const ModelContact& contact) { return contact.entry == model.contacts[number].entry; }));
}

/// A pair, and that of its corners.
std::vector<SensedPair> with_corners(const Model& model, std::size_t number) {
  const ContactPair& pair = model.contact_pairs[number];
  std::vector<SensedPair> result{{int(number), pair.exchanged}};
  for (std::size_t i = number + 1; i < model.contact_pairs.size(); ++i) {
    const ContactPair& other = model.contact_pairs[i];
    if (other.at_corners && other.facets == pair.opposite_facets && other.opposite_facets == pair.facets)
      result.push_back({int(i), other.exchanged});
  }
  return result;
}

}  // namespace

void add_standing_columns(const Case& input, Model& model) {
  model.history_bodies = bodies_of_history(model);
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    if (model.obstacles[k]->free_motion() != nullptr)
      model.sensors.push_back(make_free_body_sensor(input.obstacles[k].name, model.problem, *model.obstacles[k]));
  }
  for (std::size_t number = 0; number < model.contact_pairs.size(); ++number) {
    const ContactPair& pair = model.contact_pairs[number];
    if (!pair.has_two_sides() || pair.at_corners || count_of_entry(model, number) > most_pairs) continue;
    model.sensors.push_back(make_pair_force_sensor(model.problem, int(number), with_corners(model, number)));
  }
}

Columns history_columns(const Model& model) {
  return HistoryRecorder::columns_of(model.problem, model.sensors, model.history_bodies);
}

void find_probes(const Case& input, Model& model) {
  for (std::size_t i = 0; i < input.probes.size(); ++i) {
    ProbeTargets& targets = model.probe_targets.emplace_back();
    const ProbeKind& kind = probe_registry().find(input.probes[i].kind).type;
    if (kind.find) kind.find(setting_of(input, model, i), targets);
  }
}

void add_sensors(const Case& input, Model& model) {
  for (std::size_t i = 0; i < input.probes.size(); ++i) {
    const ProbeSection& section = input.probes[i];
    auto& sensors = section.every > 0 ? model.sampled_sensors[section.every] : model.sensors;
    const ProbeKind& kind = probe_registry().find(section.kind).type;
    for (auto& sensor : kind.make(setting_of(input, model, i), model.probe_targets[i]))
      sensors.push_back(std::move(sensor));
  }
}

}  // namespace ricochet
