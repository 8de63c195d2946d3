#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ricochet/base/log.hpp"
#include "ricochet/base/point_sets.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/keys.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Probes of the case: nodes, boundaries, groups and contacts that are watched, and their sensors.
namespace ricochet {

namespace {

/// Distances, relative to the size of the body, within which a node lies on a segment and two nodes coincide.
constexpr double on_segment = 1e-6, coincident = 1e-9;
/// Number of bodies above which their momenta have no columns: history.csv would consist of little else.
constexpr int most_bodies = 20;
/// Number of pairs of one [[contact]] above which their forces have no columns.
constexpr std::size_t most_pairs = 20;

/// Finds the parts of the mesh that probes refer to.
class ProbeFinder {
 public:
  ProbeFinder(const Case& input, Model& model) : input_(input), model_(model) {}

  ProbeTargets find(std::size_t number) {
    targets_ = {};
    const ProbeSection& section = input_.probes[number];
    const std::string key = fmt::format("probe.{}", number);
    if (!section.at.empty()) add_point(section);
    if (!section.from.empty()) add_segment(section, key);
    if (!section.boundary.empty()) add_boundary(section, key);
    if (section.contact) check_contact(section, key);
    return std::move(targets_);
  }

 private:
  void add_node(const std::string& name, Index node, double distance) {
    Probe probe{name, node, distance, -1, model_.space.number[static_cast<std::size_t>(node)]};
    const auto& nodes = model_.problem.contact.nodes;
    const auto entries = std::count(nodes.begin(), nodes.end(), node);
    if (entries > 0) probe.contact_node = nearest_contact(node);
    if (entries > 0 && std::isnan(model_.problem.contact.node_initial_gap[probe.contact_node]))
      log::info(fmt::format("probe \"{}\" is at a node that does not face the other body: it has no gap", name));
    if (entries > 1) {
      const auto first = static_cast<std::size_t>(probe.contact_node);
      const auto pair = static_cast<std::size_t>(model_.problem.contact.node_pair[first]);
      log::warning(fmt::format(
          "probe \"{}\" is at a node of {} contacts: its gap, pressure and reaction refer to {}, the nearest one at "
          "the start",
          name, entries, model_.contact_pairs[pair].opponent(model_.problem.contact.is_opposite[first] != 0)));
    }
    targets_.columns.push_back(make_point_sensor(model_.problem, probe)->columns());
    targets_.probes.push_back(std::move(probe));
    targets_.positions.emplace_back(model_.space.nodes.col(node));
  }

  /// Returns the entry of a node in ContactBoundary::nodes; among several, the one with the smallest initial gap, the
  /// first of equals.
  [[nodiscard]] Index nearest_contact(Index node) const {
    const ContactBoundary& contact = model_.problem.contact;
    Index nearest = -1;
    for (Index entry = 0; entry < static_cast<Index>(contact.nodes.size()); ++entry) {
      if (contact.nodes[static_cast<std::size_t>(entry)] != node) continue;
      // NaN marks an entry that faces nothing; any entry with a gap replaces it.
      if (nearest < 0 || (!std::isnan(contact.node_initial_gap[entry]) &&
                          !(contact.node_initial_gap[entry] >= contact.node_initial_gap[nearest])))
        nearest = entry;
    }
    return nearest;
  }

  /// Returns, among coincident nodes of two bodies in contact, one of the side that carries the multipliers, which has
  /// a gap, a pressure and a reaction.
  [[nodiscard]] Index with_multipliers(Index nearest) const {
    const ContactBoundary& contact = model_.problem.contact;
    const Points& positions = model_.space.nodes;
    const double limit = coincident * enclosing_diameter(positions);
    bool is_watched = false;
    Index best = -1;
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const Index node = contact.nodes[i];
      if (contact.is_opposite[i] != 0 || !((positions.col(node) - positions.col(nearest)).norm() <= limit)) continue;
      is_watched = is_watched || node == nearest;
      if (best < 0 || number_of(node) < number_of(best)) best = node;
    }
    return is_watched || best < 0 ? nearest : best;
  }
  [[nodiscard]] Index number_of(Index node) const { return model_.space.number[static_cast<std::size_t>(node)]; }

  void add_point(const ProbeSection& section) {
    const NearestNode nearest = nearest_node(model_.space, vector_of(section.at));
    const Index node = with_multipliers(nearest.node);
    if (node != nearest.node) {
      log::info(
          fmt::format("probe \"{}\": nodes of two bodies coincide there; it is at the node of {}, which carries the "
                      "multipliers of their contact",
                      section.name, body_of(node)));
    }
    add_node(section.name, node, nearest.distance);
    const double body_size = enclosing_diameter(model_.space.nodes);
    const std::string message =
        fmt::format("probe \"{}\": the nearest node is {:.3g} away", section.name, nearest.distance);
    if (nearest.distance > 0.1 * body_size) {
      log::warning(message + fmt::format(", far for a body of size {:.3g}", body_size));
    } else {
      log::info(message);
    }
  }

  /// Returns the name of the node's body in messages.
  [[nodiscard]] std::string body_of(Index node) const {
    const auto body = static_cast<std::size_t>(model_.bodies.connected.of_node[static_cast<std::size_t>(node)]);
    return model_.bodies.names[body];
  }

  /// Adds the nodes along a segment, from its first end to its second.
  void add_segment(const ProbeSection& section, const std::string& key) {
    const Vector from = vector_of(section.from), to = vector_of(section.to);
    const double length = (to - from).norm();
    if (!(length > 0.0)) refuse(input_, key + ".to", "the two ends of the segment are the same point");
    const Vector direction = (to - from) / length;
    const double limit = section.within.value_or(on_segment * enclosing_diameter(model_.space.nodes));
    struct Found {
      double along;
      Index number, node;
      double distance;
    };
    std::vector<Found> found;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index node = 0; node < model_.space.cell_node_count(); ++node) {
      const Vector arm = model_.space.nodes.col(node) - from;
      const double along = std::clamp(arm.dot(direction), 0.0, length);
      const double distance = (arm - along * direction).norm();
      nearest = std::min(nearest, distance);
      if (distance <= limit)
        found.push_back({along, model_.space.number[static_cast<std::size_t>(node)], node, distance});
    }
    if (found.empty()) {
      refuse(input_, key + ".from",
             fmt::format("no node lies within {:.3g} of the segment; the nearest is {:.3g} away: set \"within\"", limit,
                         nearest));
    }
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
      return std::pair(a.along, a.number) < std::pair(b.along, b.number);
    });
    for (std::size_t i = 0; i < found.size(); ++i)
      add_node(fmt::format("{}.{}", section.name, i), found[i].node, found[i].distance);
    log::info(fmt::format("probe \"{}\": {} along the segment", section.name, counted(found.size(), "node")));
  }

  void add_boundary(const ProbeSection& section, const std::string& key) {
    const std::vector<Index> facets = boundary_at(input_, key + ".boundary", model_.mesh, section.boundary);
    const std::vector<Index> nodes = facet_nodes(model_.space, facets);
    if (!model_.tied.empty() &&
        std::any_of(nodes.begin(), nodes.end(), [&](Index node) { return model_.tied.is_tied(node); })) {
      log::warning(
          fmt::format("probe \"{}\": forces transmitted by a tie are not included in the force of boundary \"{}\": "
                      "they are internal to one body",
                      section.name, section.boundary));
    }
    targets_.nodes = nodes;
    targets_.sums = describe_boundary_forces(nodes);
    log::info(fmt::format("probe \"{}\": {}", section.name, targets_.sums));
  }

  /// Describes which forces act at these nodes. At nodes that contact and a support share, only the sum of both is
  /// known.
  [[nodiscard]] std::string describe_boundary_forces(const std::vector<Index>& nodes) const {
    const SemidiscreteProblem& problem = model_.problem;
    const auto among = [&nodes](Index node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
    const std::vector<Index>& dofs = problem.supports.dofs();
    const bool is_supported =
        std::any_of(dofs.begin(), dofs.end(), [&](Index dof) { return among(dof / problem.dimension); });
    const std::vector<Index> touching = problem.contact.unique_nodes();
    const auto shared = std::count_if(touching.begin(), touching.end(), among);
    if (!is_supported && shared == 0)
      return "neither a support nor a contact acts at its nodes, and its force is zero (loads are not counted)";
    if (shared == 0) return "its force is that of the supports at its nodes (loads are not counted)";
    if (!is_supported)
      return "its force is that of the contacts at its nodes, which no support holds (loads are not counted)";
    return fmt::format(
        "its force and moment are the sum of supports and of contacts, which share {} with it; support and "
        "support_moment are those of the supports alone (loads are not counted)",
        counted(shared, "node"));
  }

  void check_contact(const ProbeSection& section, const std::string& key) {
    const auto count = static_cast<long>(input_.contacts.size());
    if (*section.contact >= count) {
      refuse(input_, key + ".contact",
             fmt::format("there is no contact {}: the case has {} of them, numbered from 0", *section.contact, count));
    }
    if (input_.contacts[static_cast<std::size_t>(*section.contact)].tied) {
      refuse(input_, key + ".contact",
             fmt::format("contact {} is tied: it has no contact points whose forces could be recorded; use a probe "
                         "with \"group\" for stresses near the surface",
                         *section.contact));
    }
    targets_.sums = describe_contact_forces(*section.contact);
  }

  [[nodiscard]] std::string describe_contact_forces(long entry) const {
    std::vector<const ContactPair*> pairs;
    for (std::size_t i = 0; i < model_.contacts.size(); ++i) {
      if (static_cast<long>(model_.contacts[i].entry) == entry) pairs.push_back(&model_.contact_pairs[i]);
    }
    if (pairs.size() != 1)
      return fmt::format(
          "its force is the sum, over {} of contact {}, of the force on the body of the first group; its area is that "
          "of the pressed parts of the sides that carry the multipliers",
          counted(pairs.size(), "pair"), entry);
    const ContactPair& pair = *pairs.front();
    const std::string on =
        pair.between_bodies() ? fmt::format("the body of \"{}\"", pair.first_group()) : std::string("the body");
    return fmt::format(
        "its force is that of all points of contact {} on {}; its area is that of the pressed part of the facets of "
        "\"{}\"",
        entry, on, pair.group);
  }

  const Case& input_;
  Model& model_;
  ProbeTargets targets_;
};

class SensorMaker {
 public:
  SensorMaker(const Case& input, Model& model) : input_(input), model_(model) {}

  void make(std::size_t number) {
    const ProbeSection& section = input_.probes[number];
    const ProbeTargets& targets = model_.probe_targets[number];
    for (std::size_t i = 0; i < targets.probes.size(); ++i) {
      const Probe& probe = targets.probes[i];
      add(section, probe.node < 0 ? make_absent_sensor(targets.columns[i]) : make_point_sensor(model_.problem, probe));
    }
    if (!section.boundary.empty()) {
      const Vector about =
          section.about.empty() ? Vector(Vector::Zero(model_.mesh.dimension)) : vector_of(section.about);
      add(section, make_boundary_sensor(section.name, model_.problem, targets.nodes, about));
    }
    if (!section.group.empty()) add_group(section, fmt::format("probe.{}", number));
    if (section.contact) add(section, make_contact_sensor(section.name, model_.problem, pairs_of(*section.contact)));
  }

 private:
  void add(const ProbeSection& section, std::shared_ptr<Sensor> sensor) {
    auto& sensors = section.every > 0 ? model_.sampled_sensors[section.every] : model_.sensors;
    sensors.push_back(std::move(sensor));
  }

  /// Returns the pairs of a [[contact]].
  [[nodiscard]] std::vector<SensedPair> pairs_of(long entry) const {
    std::vector<SensedPair> result;
    for (std::size_t i = 0; i < model_.contacts.size(); ++i) {
      if (static_cast<long>(model_.contacts[i].entry) == entry)
        result.push_back({static_cast<int>(i), model_.contact_pairs[i].exchanged});
    }
    return result;
  }

  void add_group(const ProbeSection& section, const std::string& key) {
    const int dimension = model_.mesh.dimension;
    if (model_.mesh.find_group(section.group, dimension - 1) != nullptr &&
        model_.mesh.find_group(section.group, dimension) == nullptr) {
      const Group& group = group_at(input_, key + ".group", model_.mesh, section.group, dimension - 1);
      add(section, make_facet_group_sensor(section.name, model_.body, group.members, *model_.problem.ranks));
      return;
    }
    const Group& group = group_at(input_, key + ".group", model_.mesh, section.group, dimension);
    add(section, make_cell_group_sensor(section.name, model_.body, group.members, *model_.problem.ranks));
  }

  const Case& input_;
  Model& model_;
};

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
    std::string label = label_of(names[static_cast<std::size_t>(body)], body);
    // The name of a part may be a number; no other body may then use it.
    if (label == std::to_string(body) && used_names.contains(label)) label = "body_" + label;
    while (std::find(result.labels.begin(), result.labels.end(), label) != result.labels.end()) label += "_";
    result.labels.push_back(std::move(label));
  }
  result.of_node = bodies.of_node;
  return result;
}

/// Returns the number of pairs of the same [[contact]].
std::size_t count_of_entry(const Model& model, std::size_t number) {
  return static_cast<std::size_t>(
      std::count_if(model.contacts.begin(), model.contacts.end(),
                    [&](const ModelContact& contact) { return contact.entry == model.contacts[number].entry; }));
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
    if (!pair.has_two_sides() || count_of_entry(model, number) > most_pairs) continue;
    model.sensors.push_back(make_pair_force_sensor(model.problem, static_cast<int>(number), pair.exchanged));
  }
}

Columns history_columns(const Model& model) {
  return HistoryRecorder::columns_of(model.problem, model.sensors, model.history_bodies);
}

void find_probes(const Case& input, Model& model) {
  ProbeFinder finder(input, model);
  for (std::size_t i = 0; i < input.probes.size(); ++i) model.probe_targets.push_back(finder.find(i));
}

void add_sensors(const Case& input, Model& model) {
  SensorMaker maker(input, model);
  for (std::size_t i = 0; i < input.probes.size(); ++i) maker.make(i);
}

}  // namespace ricochet
