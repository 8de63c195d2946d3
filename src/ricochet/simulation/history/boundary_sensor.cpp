#include <Eigen/Geometry>

#include "ricochet/simulation/history/sensor.hpp"

namespace ricochet {

namespace {

class BoundarySensor final : public Sensor {
 public:
  BoundarySensor(std::string name, const SemidiscreteProblem& problem, const std::vector<Index>& nodes,
                 const Vector& about)
      : name_(std::move(name)), problem_(problem), deforms_(!problem.internal_force->is_linear()), about_(about) {
    const Index d = problem.dimension;
    inside_.assign(static_cast<std::size_t>(problem.nodes.cols()), 0);
    for (const Index node : nodes) inside_[static_cast<std::size_t>(node)] = 1;
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      if (problem.axisymmetric && dof % d == 0 && problem.nodes(0, dof / d) == 0.0) continue;  // on the axis itself
      if (inside_[static_cast<std::size_t>(dof / d)] != 0) supports_.push_back({i, dof});
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
        if (inside_[static_cast<std::size_t>(node)] == 0) return;
        own.part += weight;
        own.arm += weight * arm(problem.nodes.col(node));
      });
      if (own.part != 0.0 || !own.arm.isZero(0.0)) points_.push_back(own);
    }
  }

  [[nodiscard]] Columns columns() const override {
    Columns columns;
    add_columns(".force", ".moment", columns);
    add_columns(".support", ".support_moment", columns);
    return columns;
  }

  void observe(const Observation& observation, std::vector<double>& row) override {
    const Index d = problem_.dimension;
    const State& state = observation.state;
    const StepForces& forces = state.forces;
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    for (const auto& [number, dof] : supports_) {
      const Eigen::Vector3d own = forces.support_reaction[number] * Eigen::Vector3d::Unit(dof % d);
      force += own;
      moment += arm_of(dof / d, state).cross(own);
    }
    const Eigen::Vector3d support_force = force, support_moment = moment;
    for (const Point& point : points_) {
      Eigen::Vector3d own = Eigen::Vector3d::Zero();
      own.head(d) = contact_force(forces, point.number);
      force += point.part * own;
      moment += point.arm.cross(own);
    }
    add_by_nodes(state, force, moment);
    append_values(force, moment, row);
    append_values(support_force, support_moment, row);
  }

 private:
  void add_columns(const char* force, const char* moment, Columns& columns) const {
    add_vector_columns(columns, name_ + force, problem_.dimension);
    if (problem_.dimension == 2) columns.emplace_back(name_ + moment + "_z");
    if (problem_.dimension == 3) add_vector_columns(columns, name_ + moment, 3);
  }

  void append_values(const Eigen::Vector3d& force, const Eigen::Vector3d& moment, std::vector<double>& row) const {
    const Index d = problem_.dimension;
    append(force.head(d), row);
    // Moments cancel over the ring of an axisymmetric body.
    const double part = problem_.axisymmetric ? 0.0 : 1.0;
    append(part * moment.tail(d == 2 ? 1 : 3), row);
  }

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
  void add_by_nodes(const State& state, Eigen::Vector3d& force, Eigen::Vector3d& moment) const {
    const StepForces& forces = state.forces;
    const Index d = problem_.dimension, tangents = d - 1;
    const auto add = [&](Index dof, double value) {
      if (inside_[static_cast<std::size_t>(dof / d)] == 0) return;
      const Eigen::Vector3d own = value * Eigen::Vector3d::Unit(dof % d);
      force += own;
      moment += arm_of(dof / d, state).cross(own);
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
  std::string name_;
  const SemidiscreteProblem& problem_;
  bool deforms_;
  Vector about_;
  std::vector<Support> supports_;
  std::vector<Point> points_;
  std::vector<Index> by_nodes_;  ///< points evaluated node by node
  std::vector<char> inside_;     ///< per node
};

}  // namespace

std::unique_ptr<Sensor> make_boundary_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                             const std::vector<Index>& nodes, const Vector& about) {
  return std::make_unique<BoundarySensor>(name, problem, nodes, about);
}

}  // namespace ricochet
