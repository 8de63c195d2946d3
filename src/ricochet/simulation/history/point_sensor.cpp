#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/base/log.hpp"
#include "ricochet/base/point_sets.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/contact_surface.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "ricochet/simulation/history/quantity_sensor.hpp"

// Probes at the node nearest to a point, and at the nodes along a segment.
namespace ricochet {

namespace {

class PointSensor final : public QuantitySensor<PointSensor> {
 public:
  PointSensor(const SemidiscreteProblem& problem, const Probe& probe)
      : QuantitySensor(probe.name + ".", problem),
        problem_(problem),
        probe_(probe),
        // Only one of the ranks that share the node contributes.
        part_(problem.ranks->is_owned(probe.node) ? 1.0 : 0.0) {
    if (probe_.contact_node < 0) return;
    // All points of this obstacle whose trace reaches the node contribute.
    const ContactBoundary& contact = problem.contact;
    deforms_ = contact.surface->deforms();
    has_gap_ = !std::isnan(contact.node_initial_gap[probe_.contact_node]);
    const int pair = contact.node_pair[std::size_t(probe_.contact_node)];
    const Obstacle* const obstacle = problem.obstacles[std::size_t(pair)];
    for (Index point = 0; point < contact.size(); ++point) {
      const bool is_same =
          obstacle != nullptr ? problem.obstacle_of_point(point) == obstacle : contact.pair[std::size_t(point)] == pair;
      if (!is_same) continue;
      contact.visit_nodes(point, [&](Index node, double weight) {
        if (node == probe_.node) points_.emplace_back(point, weight);
      });
    }
  }

  static const Quantities& quantities() {
    using Self = PointSensor;
    constexpr Condition<Self> is_in_contact{on_contact, [](const Self& self) { return self.probe_.contact_node >= 0; }};
    static const Quantities all{
        {{"displacement", "length",
          "displacement of the node. A probe along a segment has these columns for each of its nodes: "
          "`NAME.0.displacement_x` and so on",
          ColumnComponents::vector},
         member_value(&Self::displacement_)},
        {{"velocity", "length/time", "velocity of the node", ColumnComponents::vector}, member_value(&Self::velocity_)},
        {{"gap", "length", "gap; none if the node does not face the other body at the start"},
         member_value(&Self::gap_),
         {on_contact, [](const Self& self) { return self.has_gap_; }}},
        {{"pressure", "stress",
          "contact pressure, with [laws of finite strain](finite-strain.md) the true one, per deformed area"},
         [](const Self& self, Index) { return self.pressure_; },
         is_in_contact},
        {{"reaction_normal", "force", "normal part of the contact force on the node"},
         [](const Self& self, Index) { return self.normal_force_; },
         is_in_contact},
        {{"reaction_tangential", "force", "tangential part of the contact force on the node", ColumnComponents::vector},
         member_value(&Self::tangential_force_),
         is_in_contact},
        {{"nominal_pressure", "stress", "contact pressure per undeformed area"},
         [](const Self& self, Index) { return self.nominal_pressure_; },
         {on_contact_finite, [](const Self& self) { return self.deforms_; }}},
    };
    return all;
  }

  void evaluate(const Observation& observation) {
    const State& state = observation.state;
    const Index d = problem_.dimension;
    displacement_ = part_ * state.displacement.segment(probe_.node * d, d);
    velocity_ = part_ * state.velocity.segment(probe_.node * d, d);
    if (probe_.contact_node < 0) return;
    // Each rank contributes the force and the pressure of its contact points.
    SpaceVector force = SpaceVector::Zero(problem_.dimension);
    for (const auto& [point, weight] : points_) force += weight * contact_force(state.forces, point);
    const SpaceVector normal = problem_.node_normal(probe_.contact_node, state.displacement, state.time);
    normal_force_ = normal.dot(force);
    tangential_force_ = force - normal_force_ * normal;
    // With large sliding the node may face nothing at present.
    const double gap = observation.gap[probe_.contact_node];
    gap_ = part_ * (std::isnan(gap) ? problem_.contact.unpaired_gap : gap);
    pressure_ = observation.pressure[probe_.contact_node];
    nominal_pressure_ = observation.nominal_pressure[probe_.contact_node];
  }

 private:
  static constexpr const char* on_contact = "on a contact boundary";
  static constexpr const char* on_contact_finite =
      "on a contact boundary, with laws of [finite strain](finite-strain.md)";

  const SemidiscreteProblem& problem_;
  Probe probe_;
  double part_;
  bool has_gap_ = false;  ///< false if the node faces nothing
  bool deforms_ = false;  ///< its pressure differs from the nominal one
  double gap_ = 0.0, pressure_ = 0.0, nominal_pressure_ = 0.0, normal_force_ = 0.0;
  SpaceVector displacement_, velocity_, tangential_force_;
  std::vector<std::pair<Index, double>> points_;  ///< with the fraction of their force that acts on the node
};

/// Sensor with these columns, all of them sums, which appends zeros: for a node that other ranks hold.
class AbsentSensor final : public Sensor {
 public:
  explicit AbsentSensor(Columns columns) : columns_(std::move(columns)) {}
  [[nodiscard]] Columns columns() const override { return columns_; }
  void observe(const Observation&, std::vector<double>& row) override { row.insert(row.end(), columns_.size(), 0.0); }

 private:
  Columns columns_;
};

/// Distances, relative to the size of the body, within which a node lies on a segment and two nodes coincide.
constexpr double on_segment = 1e-6, coincident = 1e-9;

/// Returns the entry of a node in ContactBoundary::nodes; among several, the one with the smallest initial gap, the
/// first of equals.
Index nearest_contact(const ContactBoundary& contact, Index node) {
  Index nearest = -1;
  for (Index entry = 0; entry < Index(contact.nodes.size()); ++entry) {
    if (contact.nodes[std::size_t(entry)] != node) continue;
    // NaN marks an entry that faces nothing; any entry with a gap replaces it.
    if (nearest < 0 || (!std::isnan(contact.node_initial_gap[entry]) &&
                        !(contact.node_initial_gap[entry] >= contact.node_initial_gap[nearest])))
      nearest = entry;
  }
  return nearest;
}

/// Returns, among coincident nodes of two bodies in contact, one of the side that carries the multipliers, which has a
/// gap, a pressure and a reaction.
Index with_multipliers(const DisplacementSpace& space, const ContactBoundary& contact, Index nearest) {
  const Points& positions = space.nodes;
  const double limit = coincident * enclosing_diameter(positions);
  const auto number_of = [&space](Index node) { return space.number[std::size_t(node)]; };
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

/// Returns whether a contact node of another body coincides with this one.
bool touches_another_body(const ProbeContext& setting, Index node) {
  const Points& positions = setting.body.space->nodes;
  const double limit = coincident * enclosing_diameter(positions);
  const auto body_of = [&](Index any) { return setting.bodies.connected.of_node[std::size_t(any)]; };
  const std::vector<Index>& nodes = setting.problem.contact.nodes;
  return std::ranges::any_of(nodes, [&](Index other) {
    return (positions.col(other) - positions.col(node)).norm() <= limit && body_of(other) != body_of(node);
  });
}

void add_node(const ProbeContext& setting, const std::string& name, Index node, double distance,
              ProbeTargets& targets) {
  const DisplacementSpace& space = *setting.body.space;
  const ContactBoundary& contact = setting.problem.contact;
  Probe probe{name, node, distance, -1, space.number[std::size_t(node)]};
  const auto entries = std::ranges::count(contact.nodes, node);
  if (entries > 0) probe.contact_node = nearest_contact(contact, node);
  if (entries > 0 && std::isnan(contact.node_initial_gap[probe.contact_node]))
    log::info(fmt::format("probe \"{}\" is at a node that does not face the other body: it has no gap", name));
  if (entries > 1) {
    const auto first = std::size_t(probe.contact_node);
    const auto pair = std::size_t(contact.node_pair[first]);
    log::warning(fmt::format(
        "probe \"{}\" is at a node of {} contacts: its gap, pressure and reaction refer to {}, the nearest one at "
        "the start",
        name, entries, setting.pairs[pair].opponent(contact.is_opposite[first] != 0)));
  }
  targets.columns.push_back(make_point_sensor(setting.problem, probe)->columns());
  targets.probes.push_back(std::move(probe));
  targets.positions.emplace_back(space.nodes.col(node));
}

void find_point(const ProbeContext& setting, ProbeTargets& targets) {
  const DisplacementSpace& space = *setting.body.space;
  const NearestNode nearest = nearest_node(space, setting.vector("at"));
  const Index node = with_multipliers(space, setting.problem.contact, nearest.node);
  if (touches_another_body(setting, node)) {
    const int body = setting.bodies.connected.of_node[std::size_t(node)];
    log::info(
        fmt::format("probe \"{}\": nodes of two bodies coincide there; it is at the node of {}, which carries "
                    "the multipliers of their contact",
                    setting.name, setting.bodies.names[std::size_t(body)]));
  }
  add_node(setting, setting.name, node, nearest.distance, targets);
  const double body_size = enclosing_diameter(space.nodes);
  const std::string message =
      fmt::format("probe \"{}\": the nearest node is {:.3g} away", setting.name, nearest.distance);
  if (nearest.distance > 0.1 * body_size) {
    log::warning(message + fmt::format(", far for a body of size {:.3g}", body_size));
  } else {
    log::info(message);
  }
}

/// Adds the nodes along a segment, from its first end to its second.
void find_segment(const ProbeContext& setting, ProbeTargets& targets) {
  const DisplacementSpace& space = *setting.body.space;
  const Vector from = setting.vector("from"), to = setting.vector("to");
  const double length = (to - from).norm();
  if (!(length > 0.0)) setting.refuse("to", "the two ends of the segment are the same point");
  const Vector direction = (to - from) / length;
  const double limit =
      setting.values.has("within") ? setting.values.number("within") : on_segment * enclosing_diameter(space.nodes);
  struct Found {
    double along;
    Index number, node;
    double distance;
  };
  std::vector<Found> found;
  double nearest = std::numeric_limits<double>::infinity();
  for (Index node = 0; node < space.cell_node_count(); ++node) {
    const Vector arm = space.nodes.col(node) - from;
    const double along = std::clamp(arm.dot(direction), 0.0, length);
    const double distance = (arm - along * direction).norm();
    nearest = std::min(nearest, distance);
    if (distance <= limit) found.push_back({along, space.number[std::size_t(node)], node, distance});
  }
  if (found.empty()) {
    setting.refuse("from",
                   fmt::format("no node lies within {:.3g} of the segment; the nearest is {:.3g} away: set \"within\"",
                               limit, nearest));
  }
  std::ranges::sort(found, [](const Found& a, const Found& b) {
    return std::pair(a.along, a.number) < std::pair(b.along, b.number);
  });
  for (std::size_t i = 0; i < found.size(); ++i)
    add_node(setting, fmt::format("{}.{}", setting.name, i), found[i].node, found[i].distance, targets);
  log::info(fmt::format("probe \"{}\": {} along the segment", setting.name, counted(found.size(), "node")));
}

SensorList make_point_probe(const ProbeContext& setting, const ProbeTargets& targets) {
  SensorList sensors;
  for (std::size_t i = 0; i < targets.probes.size(); ++i) {
    if (targets.probes[i].node < 0) {
      sensors.push_back(std::make_shared<AbsentSensor>(targets.columns[i]));
    } else {
      sensors.push_back(make_point_sensor(setting.problem, targets.probes[i]));
    }
  }
  return sensors;
}

}  // namespace

Registration<ProbeKind> point_probe() {
  return {.name = "at",
          .type = {.quantities = PointSensor::descriptions(), .find = find_point, .make = make_point_probe},
          .keys = {vector_key(
              "at", "length", {},
              "A point: the probe uses the nearest node and reports its distance. Columns NAME.displacement_x …, "
              "velocity_x …, and on a contact boundary gap, pressure, reaction_normal, reaction_tangential_x …. If "
              "nodes of two bodies in contact coincide there, it uses the node on the side with the multipliers.")},
          .alternatives = {{"at"}}};
}

Registration<ProbeKind> segment_probe() {
  return {
      .name = "from",
      .type = {.quantities = {}, .find = find_segment, .make = make_point_probe},
      .keys = {vector_key(
                   "from", "length", {},
                   "One end of a segment. All nodes along it, numbered from this end, have the columns of a point: "
                   "NAME.0.displacement_x and so on."),
               vector_key("to", "length", {}, "The other end of the segment."),
               number_key("within", "length", {.range = positive},
                          "Nodes within this distance of the segment belong to it. Default: 1e-6 of the body's size.")},
      .alternatives = {{"from", "to"}}};
}

std::unique_ptr<Sensor> make_point_sensor(const SemidiscreteProblem& problem, const Probe& probe) {
  return std::make_unique<PointSensor>(problem, probe);
}

}  // namespace ricochet
