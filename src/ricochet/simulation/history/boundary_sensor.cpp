#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/tied_nodes.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "ricochet/simulation/history/quantity_sensor.hpp"

namespace ricochet {

namespace {

class BoundarySensor final : public QuantitySensor<BoundarySensor> {
 public:
  BoundarySensor(const std::string& name, const SemidiscreteProblem& problem, const std::vector<Index>& nodes,
                 const Vector& about)
      : QuantitySensor(name + ".", problem),
        problem_(problem),
        deforms_(!problem.internal_force->is_linear()),
        about_(about) {
    const Index d = problem.dimension;
    inside_.assign(std::size_t(problem.nodes.cols()), 0);
    for (const Index node : nodes) inside_[std::size_t(node)] = 1;
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[std::size_t(i)];
      if (problem.axisymmetric && dof % d == 0 && problem.nodes(0, dof / d) == 0.0) continue;  // on the axis itself
      if (inside_[std::size_t(dof / d)] != 0) supports_.push_back({i, dof});
    }
    // The part Σ c_ij of a point's force acts on these nodes, with the moment Σ c_ij X_j × force if positions are those
    // of the reference.
    for (Index point = 0; point < problem.contact.size(); ++point) {
      if (deforms_ || problem.contact.slides(point)) {
        by_nodes_.push_back(point);
        continue;
      }
      Point own{point, 0.0, Eigen::Vector3d::Zero()};
      problem.contact.visit_nodes(point, [&](Index node, double weight) {
        if (inside_[std::size_t(node)] == 0) return;
        own.part += weight;
        own.arm += weight * arm(problem.nodes.col(node));
      });
      if (own.part != 0.0 || !own.arm.isZero(0.0)) points_.push_back(own);
    }
  }

  static const Quantities& quantities() {
    using Self = BoundarySensor;
    static const Quantities all{
        {{"force", "force", "total force that supports and contacts, also those of other bodies, exert on its nodes",
          ColumnComponents::vector},
         member_value(&Self::force_)},
        {{"moment", "force·length", "moment of these forces; 0 for axisymmetric bodies", ColumnComponents::axial},
         member_value(&Self::moment_)},
        {{"support", "force", "[force of the supports alone](#supports-and-contacts)", ColumnComponents::vector},
         member_value(&Self::support_force_)},
        {{"support_moment", "force·length", "moment of the supports alone", ColumnComponents::axial},
         member_value(&Self::support_moment_)},
    };
    return all;
  }

  void evaluate(const Observation& observation) {
    const Index d = problem_.dimension;
    const State& state = observation.state;
    const StepForces& forces = state.forces;
    force_ = moment_ = Eigen::Vector3d::Zero();
    for (const auto& [number, dof] : supports_) {
      const Eigen::Vector3d own = forces.support_reaction[number] * Eigen::Vector3d::Unit(dof % d);
      force_ += own;
      moment_ += arm_of(dof / d, state).cross(own);
    }
    support_force_ = force_;
    support_moment_ = moment_;
    for (const Point& point : points_) {
      Eigen::Vector3d own = Eigen::Vector3d::Zero();
      own.head(d) = contact_force(forces, point.number);
      force_ += point.part * own;
      moment_ += point.arm.cross(own);
    }
    add_by_nodes(state);
    if (!problem_.axisymmetric) return;
    moment_ *= 0.0;  // moments cancel over the ring
    support_moment_ *= 0.0;
  }

 private:
  /// Vector from `about` to a position.
  template <class Position>
  [[nodiscard]] Eigen::Vector3d arm(const Position& position) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    result.head(problem_.dimension) = position - about_;
    return result;
  }

  /// Lever arm of a node, at finite strain at its current position, as for the angular momentum of the history.
  [[nodiscard]] Eigen::Vector3d arm_of(Index node, const State& state) const {
    const Index d = problem_.dimension;
    if (!deforms_) return arm(problem_.nodes.col(node));
    return arm(problem_.nodes.col(node) + state.displacement.segment(node * d, d));
  }

  /// Adds, node by node, the forces of points whose nodes move or whose rows reach other nodes in large sliding.
  void add_by_nodes(const State& state) {
    const StepForces& forces = state.forces;
    const Index d = problem_.dimension, tangents = d - 1;
    const auto add = [&](Index dof, double value) {
      if (inside_[std::size_t(dof / d)] == 0) return;
      const Eigen::Vector3d own = value * Eigen::Vector3d::Unit(dof % d);
      force_ += own;
      moment_ += arm_of(dof / d, state).cross(own);
    };
    for (const Index point : by_nodes_) {
      const double normal = forces.normal_reaction[point];
      if (normal != 0.0) forces.rows->visit_normal(point, [&](Index dof, double value) { add(dof, value * normal); });
      if (forces.tangential_reaction.size() == 0) continue;
      for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
        const double tangential = forces.tangential_reaction[row];
        forces.rows->visit_tangential(row, [&](Index dof, double value) { add(dof, -value * tangential); });
      }
    }
  }

  struct Support {
    Index number, dof;
  };
  struct Point {
    Index number;
    double part;
    Eigen::Vector3d arm;
  };
  const SemidiscreteProblem& problem_;
  bool deforms_;
  Vector about_;
  std::vector<Support> supports_;
  std::vector<Point> points_;
  std::vector<Index> by_nodes_;  ///< points evaluated node by node
  std::vector<char> inside_;     ///< per node
  Eigen::Vector3d force_, moment_, support_force_, support_moment_;
};

/// Describes which forces act at these nodes. At nodes that contact and a support share, only the sum of both is known.
std::string describe_boundary_forces(const SemidiscreteProblem& problem, const std::vector<Index>& nodes) {
  const auto among = [&nodes](Index node) { return std::ranges::binary_search(nodes, node); };
  const std::vector<Index>& dofs = problem.supports.dofs();
  const bool is_supported = std::ranges::any_of(dofs, [&](Index dof) { return among(dof / problem.dimension); });
  const std::vector<Index> touching = problem.contact.unique_nodes();
  const auto shared = std::ranges::count_if(touching, among);
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

void find_boundary(const ProbeContext& probe, ProbeTargets& targets) {
  targets.nodes = facet_nodes(*probe.body.space, probe.boundary("boundary"));
  const TiedNodes* const tied = probe.body.tied;
  if (tied != nullptr && std::ranges::any_of(targets.nodes, [tied](Index node) { return tied->is_tied(node); })) {
    log::warning(
        fmt::format("probe \"{}\": forces transmitted by a tie are not included in the force of boundary \"{}\": "
                    "they are internal to one body",
                    probe.name, probe.values.text("boundary")));
  }
  targets.summed_forces = describe_boundary_forces(probe.problem, targets.nodes);
  log::info(fmt::format("probe \"{}\": {}", probe.name, targets.summed_forces));
}

SensorList make_boundary_probe(const ProbeContext& probe, const ProbeTargets& targets) {
  return {make_boundary_sensor(probe.name, probe.problem, targets.nodes, probe.vector("about"))};
}

}  // namespace

Registration<ProbeKind> boundary_probe() {
  return {
      .name = "boundary",
      .type = {.quantities = BoundarySensor::descriptions(),
               .of_boundary = true,
               .find = find_boundary,
               .make = make_boundary_probe},
      .keys =
          {typed_key(
               "boundary", KeyType::groups, "", {},
               "Group of boundary facets, or a list of groups. Columns: force and moment on the body at its nodes, "
               "from supports and contacts together (prescribed loads are not included), NAME.force_x …, "
               "NAME.moment_z, in 3D NAME.moment_x …; and from the supports alone, NAME.support_x …, "
               "NAME.support_moment_z, in 3D NAME.support_moment_x …"),
           vector_key(
               "about", "length", {},
               "Reference point of the moment on a boundary, in the reference configuration. Default: the origin.")},
      .alternatives = {{"boundary"}}};
}

std::unique_ptr<Sensor> make_boundary_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                             const std::vector<Index>& nodes, const Vector& about) {
  return std::make_unique<BoundarySensor>(name, problem, nodes, about);
}

}  // namespace ricochet
