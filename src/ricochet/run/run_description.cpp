#include "ricochet/run/run_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ricochet/linear_algebra/library_versions.hpp"
#include "ricochet/run/rotation_watch.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

ContactDescription describe_contact(const Case& input, const ContactSection& contact,
                                    const std::string& all_pairs_group) {
  ContactDescription result{contact.group, contact.against, contact.multipliers, contact.friction,
                            contact.friction_bound};
  result.between_bodies = contact.between_bodies();
  result.tied = contact.tied;
  result.all_pairs_group = all_pairs_group;
  if (result.between_bodies) return result;
  const auto obstacle =
      std::ranges::find_if(input.obstacles, [&](const ObstacleSection& o) { return o.name == contact.obstacle; });
  result.opponent = contact.obstacle;
  result.obstacle_velocity = obstacle->velocity;
  result.obstacle_rotation_rate = obstacle->rotation_rate;
  result.obstacle_moves_freely = obstacle->is_free();
  return result;
}

}  // namespace

std::vector<ContactDescription> describe_contacts(const Case& input) {
  std::vector<ContactDescription> result;
  for (const ContactSection& contact : input.contacts)
    result.push_back(describe_contact(input, contact, contact.is_of_all_pairs() ? contact.group : ""));
  return result;
}

std::optional<PairingDescription> describe_facing(const Model& model, std::size_t contact) {
  const ContactPair& pair = model.contact_pairs[contact];
  if (!pair.has_two_sides() || pair.at_corners) return {};
  const PairingSummary& facing = model.pair_facings[contact];
  PairingDescription result{pair.group, pair.side_reason, facing.points};
  result.covered = facing.area > 0.0 ? facing.covered / facing.area : 0.0;
  const auto without_rounding = [&](double gap) { return std::abs(gap) <= facing.gap_rounding ? 0.0 : gap; };
  if (facing.points > 0) {
    result.smallest_gap = without_rounding(facing.smallest_gap);
    result.largest_gap = without_rounding(facing.largest_gap);
  }
  return result;
}

RunSummary describe_run(const Case& input, const Model& model, const Scheme& scheme, const Simulation& simulation) {
  RunSummary summary;
  summary.case_file = input.path;
  summary.title = input.title;
  summary.version = version;
  summary.scheme = input.time.scheme;
  summary.mass = input.mass.type;
  summary.mass_built = model.mass_built;
  summary.libraries = library_versions();
  summary.overrides = input.overridden;
  summary.parameters = input.values;
  summary.all_steps = step_count(input.time);
  summary.dimension = model.mesh.dimension;
  summary.degree = model.space.degree;
  summary.nodes = model.sizes.nodes;
  summary.cells = model.sizes.cells;
  summary.dofs = model.sizes.dofs;
  summary.contact_points = model.sizes.contact_points;
  summary.supported_dofs = model.sizes.supported_dofs;
  summary.factor_entries = simulation.factor_entries();
  const std::vector<ChosenMethod>& methods = simulation.methods();
  const auto iterative = std::ranges::find_if(
      methods, [](const ChosenMethod& chosen) { return chosen.method == SolverMethod::iterative; });
  summary.solver = iterative != methods.end() ? "iterative" : "direct";
  if (!methods.empty()) summary.solver_reason = (iterative != methods.end() ? *iterative : methods.front()).reason;
  summary.step = input.time.step;
  summary.end_time = input.time.end;
  summary.critical_step = scheme.critical_step();
  summary.energy_instant = scheme.traits().energy_instant;
  summary.force_instant = scheme.traits().force_instant;
  summary.rotation.limit = limit_of_rotation(model.body);
  for (std::size_t i = 0; i < model.contacts.size() && !model.contact_pairs[i].at_corners; ++i)
    summary.contacts.push_back(describe_contact(input, model.contacts[i], model.contacts[i].all_pairs_group));
  for (std::size_t i = 0; i < summary.contacts.size(); ++i) summary.contacts[i].facing = describe_facing(model, i);
  for (std::size_t number = 0; number < model.probe_targets.size(); ++number) {
    const ProbeTargets& targets = model.probe_targets[number];
    if (!targets.summed_forces.empty())
      summary.probe_sums.emplace_back(input.probes[number].name, targets.summed_forces);
    for (std::size_t i = 0; i < targets.probes.size(); ++i) {
      const Vector& at = targets.positions[i];
      summary.probes.push_back({targets.probes[i], {at.data(), at.data() + at.size()}});
      summary.probes.back().probe.node = targets.probes[i].number;
    }
  }
  return summary;
}

ContactProvenance describe_provenance(const Case& input, const RunSummary& summary) {
  ContactProvenance result;
  result.title = input.title.empty() ? std::filesystem::path(input.path).stem().string() : input.title;
  result.dimension = summary.dimension;
  result.step_size = summary.step;
  std::string overrides;
  for (const std::string& key : summary.overrides) {
    const auto value = input.values.find(key);
    overrides += fmt::format(" {}{}", key, value != input.values.end() ? "=" + value->second : "");
  }
  result.origin = fmt::format("Ricochet {}, case {}{}{}; scheme {}", summary.version, input.path,
                              overrides.empty() ? "" : " with --set", overrides, scheme_text(input.time));
  result.origin += fmt::format(", step size {:g}, mass {}, multipliers", summary.step, summary.mass_text());
  std::vector<std::string> spaces;
  for (const ContactSection& contact : input.contacts) {
    if (std::ranges::find(spaces, contact.multipliers) == spaces.end()) spaces.push_back(contact.multipliers);
  }
  for (const std::string& space : spaces) result.origin += " " + space;
  result.origin += fmt::format(", displacement of degree {}, {} dofs.", summary.degree, summary.dofs);
  return result;
}

}  // namespace ricochet
