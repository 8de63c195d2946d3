#include <cmath>
#include <utility>

#include "ricochet/contact/contact_surface.hpp"
#include "ricochet/simulation/history/sensor.hpp"

namespace ricochet {

namespace {

class PointSensor final : public Sensor {
 public:
  PointSensor(const SemidiscreteProblem& problem, Probe probe) : problem_(problem), probe_(std::move(probe)) {
    if (probe_.contact_node < 0) return;
    // All points of this obstacle whose trace reaches the node contribute.
    const ContactBoundary& contact = problem.contact;
    deforms_ = contact.surface->deforms();
    has_gap_ = !std::isnan(contact.node_initial_gap[probe_.contact_node]);
    const int pair = contact.node_pair[static_cast<std::size_t>(probe_.contact_node)];
    const Obstacle* const obstacle = problem.obstacles[static_cast<std::size_t>(pair)];
    for (Index point = 0; point < contact.size(); ++point) {
      const bool is_same = obstacle != nullptr ? problem.obstacle_of_point(point) == obstacle
                                               : contact.pair[static_cast<std::size_t>(point)] == pair;
      if (!is_same) continue;
      contact.visit_nodes(point, [&](Index node, double weight) {
        if (node == probe_.node) points_.emplace_back(point, weight);
      });
    }
  }

  [[nodiscard]] Columns columns() const override {
    Columns columns;
    const int d = problem_.dimension;
    add_vector_columns(columns, probe_.name + ".displacement", d);
    add_vector_columns(columns, probe_.name + ".velocity", d);
    if (probe_.contact_node < 0) return columns;
    if (has_gap_) columns.emplace_back(probe_.name + ".gap");
    for (const char* name : {".pressure", ".reaction_normal"}) columns.emplace_back(probe_.name + name);
    add_vector_columns(columns, probe_.name + ".reaction_tangential", d);
    if (deforms_) columns.emplace_back(probe_.name + ".nominal_pressure");
    return columns;
  }

  void observe(const Observation& observation, std::vector<double>& row) override {
    const Index d = problem_.dimension;
    const State& state = observation.state;
    // Only one of the ranks that share the node contributes.
    const double part = problem_.ranks->is_owned(probe_.node) ? 1.0 : 0.0;
    append(part * state.displacement.segment(probe_.node * d, d), row);
    append(part * state.velocity.segment(probe_.node * d, d), row);
    if (probe_.contact_node < 0) return;
    SpaceVector force = SpaceVector::Zero(d);
    for (const auto& [point, weight] : points_) force += weight * contact_force(state.forces, point);
    const SpaceVector normal = problem_.node_normal(probe_.contact_node, state.displacement, state.time);
    const double normal_force = normal.dot(force);
    if (has_gap_) {
      // With large sliding the node may face nothing at present.
      const double gap = observation.gap[probe_.contact_node];
      row.push_back(part * (std::isnan(gap) ? problem_.contact.unpaired_gap : gap));
    }
    // Each rank contributes the force and the pressure of its contact points.
    for (const double value : {observation.pressure[probe_.contact_node], normal_force}) row.push_back(value);
    force -= normal_force * normal;
    append(force, row);
    if (deforms_) row.push_back(observation.nominal_pressure[probe_.contact_node]);
  }

 private:
  const SemidiscreteProblem& problem_;
  Probe probe_;
  bool has_gap_ = false;                          ///< false if the node faces nothing
  bool deforms_ = false;                          ///< its pressure differs from the nominal one
  std::vector<std::pair<Index, double>> points_;  ///< with the fraction of their force that acts on the node
};

}  // namespace

std::unique_ptr<Sensor> make_point_sensor(const SemidiscreteProblem& problem, const Probe& probe) {
  return std::make_unique<PointSensor>(problem, probe);
}

}  // namespace ricochet
