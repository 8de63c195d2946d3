#include "ricochet/simulation/impact/rigid_bodies.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

#include "ricochet/simulation/statics/held_bodies.hpp"

namespace ricochet {

RigidBodies::RigidBodies(const SemidiscreteProblem& problem, std::vector<int> body_of_node, int count)
    : problem_(problem),
      body_of_node_(std::move(body_of_node)),
      origin_(std::size_t(count), Eigen::Vector3d::Zero()),
      bodies_(std::size_t(count)),
      motion_(std::size_t(count)) {
  std::vector<double> nodes(static_cast<std::size_t>(count), 0.0);
  for (Index node = 0; node < problem_.cell_node_count(); ++node) {
    if (!problem.ranks->is_owned(node)) continue;
    const auto b = std::size_t(this->body_of_node(node));
    origin_[b].head(problem.dimension) += problem.nodes.col(node);
    nodes[b] += 1.0;
  }
  sum_over_ranks(origin_);
  problem.ranks->sum(nodes);
  for (std::size_t b = 0; b < nodes.size(); ++b) origin_[b] /= nodes[b];
  find_supported_bodies();
  if (problem.axisymmetric) {
    measure_axisymmetric();
  } else {
    measure();
  }
  add_free_bodies();
}

void RigidBodies::add_free_bodies() {
  const int d = problem_.dimension;
  for (const auto& body : problem_.free_bodies) {
    const FreeMotion::Inertia& inertia = body->inertia();
    RigidBody& added = bodies_.emplace_back();
    added.mass = inertia.mass;
    added.centre.head(d) = inertia.centre;
    if (d == 2) {
      added.inertia(2, 2) = inertia.moments[0];
    } else {
      const Eigen::Matrix3d axes = inertia.principal.size() > 0 ? Eigen::Matrix3d(inertia.principal)
                                                                : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
      added.inertia = axes * Eigen::Vector3d(inertia.moments).asDiagonal() * axes.transpose();
    }
    const std::vector<Index>& dofs = problem_.supports.dofs();
    const Index first = body->centre_node() * d, rotations = body->gyration().size();
    const auto supported_dofs =
        std::ranges::count_if(dofs, [&](Index dof) { return dof >= first && dof < first + d + rotations; });
    added.held = supported_dofs == d + rotations;
  }
  motion_.resize(bodies_.size());
}

void RigidBodies::sum_over_ranks(std::vector<Eigen::Vector3d>& values) const {
  if (!values.empty()) problem_.ranks->sum({values.front().data(), 3 * values.size()});
}

void RigidBodies::find_supported_bodies() {
  if (!problem_.ranks->any(problem_.supports.size() > 0)) return;
  std::vector<std::vector<Index>> members(bodies_.size());
  for (Index node = 0; node < problem_.cell_node_count(); ++node)
    members[std::size_t(body_of_node(node))].push_back(node);
  for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b].held = are_fixed_at_rest(problem_, members[b]);
}

Eigen::Vector3d RigidBodies::arm(Index node) const {
  Eigen::Vector3d result = -origin_[std::size_t(body_of_node(node))];
  result.head(problem_.dimension) += problem_.nodes.col(node);
  return result;
}

/// Computes RᵀMR with the rigid velocities R about each body's origin: mass, first and second moments.
void RigidBodies::measure() {
  const int d = problem_.dimension, first_rotation = d == 2 ? 2 : 0;
  Vector velocity(problem_.dof_count());
  const auto momentum_of = [&](const auto& rigid) {
    for (Index node = 0; node < problem_.cell_node_count(); ++node)
      velocity.segment(node * d, d) = Eigen::Vector3d(rigid(node)).head(d);
    problem_.mass.multiply(velocity, momentum_);
  };
  const auto for_each_node = [&](const auto& visit) {
    for (Index node = 0; node < problem_.cell_node_count(); ++node) {
      Eigen::Vector3d own = Eigen::Vector3d::Zero();
      own.head(d) = momentum_.segment(node * d, d);
      visit(std::size_t(body_of_node(node)), arm(node), own);
    }
  };
  // A translation along k has the momentum m e_k and the moment m c × e_k, which yields two components of the centre c.
  std::vector<Eigen::Vector3d> offset(bodies_.size(), Eigen::Vector3d::Zero());
  for (int k = 0; k < 2; ++k) {
    momentum_of([&](Index) { return Eigen::Vector3d::Unit(k); });
    std::vector<Eigen::Vector3d> moment(bodies_.size(), Eigen::Vector3d::Zero());
    for_each_node([&](std::size_t b, const Eigen::Vector3d& at, const Eigen::Vector3d& own) {
      if (k == 0) bodies_[b].mass += own[0];
      moment[b] += at.cross(own);
    });
    sum_over_ranks(moment);
    for (std::size_t b = 0; k == 0 && b < bodies_.size(); ++b) bodies_[b].mass = problem_.ranks->sum(bodies_[b].mass);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (k == 0) offset[b][1] = -moment[b][2] / bodies_[b].mass;
      if (k == 0) offset[b][2] = moment[b][1] / bodies_[b].mass;
      if (k == 1) offset[b][0] = moment[b][2] / bodies_[b].mass;
    }
  }
  for (int k = first_rotation; k < 3; ++k) {
    momentum_of([&](Index node) { return Eigen::Vector3d::Unit(k).cross(arm(node)); });
    for_each_node([&](std::size_t b, const Eigen::Vector3d& at, const Eigen::Vector3d& own) {
      bodies_[b].inertia.col(k) += at.cross(own);
    });
  }
  for (RigidBody& body : bodies_) problem_.ranks->sum({body.inertia.data(), 9});
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    RigidBody& body = bodies_[b];
    body.centre = origin_[b] + offset[b];
    // Steiner: from the origin of the sums to the centre of mass.
    body.inertia -=
        body.mass * (offset[b].squaredNorm() * Eigen::Matrix3d::Identity() - offset[b] * offset[b].transpose());
  }
}

/// Measures the whole solid, with the moments xᵀmx, yᵀmy, yᵀm1 of M = m ⊗ I, x the distance from the axis.
void RigidBodies::measure_axisymmetric() {
  for (Eigen::Vector3d& origin : origin_) origin[0] = 0.0;
  Vector positions(problem_.dof_count());
  for (Index node = 0; node < problem_.cell_node_count(); ++node) positions.segment(node * 2, 2) = arm(node).head(2);
  problem_.mass.multiply(positions, momentum_);
  const Vector moments = momentum_;
  problem_.mass.multiply(Vector::Ones(problem_.dof_count()), momentum_);
  std::vector<double> along(bodies_.size(), 0.0), squared(bodies_.size(), 0.0), across(bodies_.size(), 0.0);
  for (Index node = 0; node < problem_.cell_node_count(); ++node) {
    const auto b = std::size_t(body_of_node(node));
    bodies_[b].mass += momentum_[node * 2 + 1];
    along[b] += moments[node * 2 + 1];
    across[b] += positions[node * 2] * moments[node * 2];
    squared[b] += positions[node * 2 + 1] * moments[node * 2 + 1];
  }
  for (std::vector<double>* const each : {&along, &squared, &across}) problem_.ranks->sum(*each);
  for (RigidBody& body : bodies_) body.mass = problem_.ranks->sum(body.mass);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const double offset = along[b] / bodies_[b].mass;
    bodies_[b].centre = origin_[b] + offset * Eigen::Vector3d::UnitY();
    const double transverse = 0.5 * across[b] + squared[b] - bodies_[b].mass * offset * offset;
    bodies_[b].inertia.diagonal() << transverse, across[b], transverse;
  }
}

/// Computes centres and inertia at current positions x, from Σ x_a (M x)_aᵀ about each body's origin.
void RigidBodies::measure_at(const Vector& displacement) {
  const int d = problem_.dimension;
  position_.resize(problem_.dof_count());
  for (Index node = 0; node < problem_.cell_node_count(); ++node) {
    const auto b = std::size_t(body_of_node(node));
    position_.segment(node * d, d) = problem_.nodes.col(node) + displacement.segment(node * d, d) - origin_[b].head(d);
  }
  problem_.mass.multiply(position_, weighted_);
  centre_.assign(origin_.size(), Eigen::Vector3d::Zero());
  inertia_.assign(origin_.size(), Eigen::Matrix3d::Zero());
  for (Index node = 0; node < problem_.cell_node_count(); ++node) {
    const auto b = std::size_t(body_of_node(node));
    centre_[b].head(d) += weighted_.segment(node * d, d);
    inertia_[b].topLeftCorner(d, d) += position_.segment(node * d, d) * weighted_.segment(node * d, d).transpose();
  }
  for (std::size_t b = 0; b < origin_.size(); ++b) {
    centre_[b] /= bodies_[b].mass;
    const Eigen::Matrix3d about =
        0.5 * (inertia_[b] + inertia_[b].transpose()) - bodies_[b].mass * centre_[b] * centre_[b].transpose();
    inertia_[b] = about.trace() * Eigen::Matrix3d::Identity() - about;
  }
}

const std::vector<RigidMotionState>& RigidBodies::motion(const Vector& velocity, const Vector& displacement) {
  const int d = problem_.dimension;
  const bool uses_current_positions = !problem_.internal_force->is_linear();
  if (uses_current_positions) measure_at(displacement);
  problem_.mass.multiply(velocity, momentum_);
  for (RigidMotionState& state : motion_) state = {};
  for (Index node = 0; node < problem_.cell_node_count(); ++node) {
    const auto b = std::size_t(body_of_node(node));
    Eigen::Vector3d own = Eigen::Vector3d::Zero(), from_centre = arm(node) + origin_[b] - bodies_[b].centre;
    own.head(d) = momentum_.segment(node * d, d);
    if (uses_current_positions) from_centre.head(d) = position_.segment(node * d, d) - centre_[b].head(d);
    motion_[b].velocity += own;
    motion_[b].spin += from_centre.cross(own);
    motion_[b].kinetic_energy += 0.5 * momentum_.segment(node * d, d).dot(velocity.segment(node * d, d));
  }
  for (std::size_t b = 0; problem_.ranks->are_several() && b < origin_.size(); ++b) {
    problem_.ranks->sum({motion_[b].velocity.data(), 3});
    problem_.ranks->sum({motion_[b].spin.data(), 3});
    motion_[b].kinetic_energy = problem_.ranks->sum(motion_[b].kinetic_energy);
  }
  for (std::size_t b = 0; b < origin_.size(); ++b) {
    const RigidBody& body = bodies_[b];
    const Eigen::Matrix3d& inertia = uses_current_positions ? inertia_[b] : body.inertia;
    if (problem_.axisymmetric) motion_[b].velocity[0] = 0.0;
    const Eigen::Vector3d angular_momentum = problem_.axisymmetric ? Eigen::Vector3d::Zero() : motion_[b].spin;
    motion_[b].velocity /= body.mass;
    if (d == 2) {
      motion_[b].spin = {0.0, 0.0, angular_momentum[2] / inertia(2, 2)};
    } else {
      motion_[b].spin = inertia.ldlt().solve(angular_momentum);
    }
    motion_[b].rigid_kinetic_energy =
        0.5 * (body.mass * motion_[b].velocity.squaredNorm() + motion_[b].spin.dot(angular_momentum));
  }
  for (std::size_t k = 0; k < problem_.free_bodies.size(); ++k) {
    const FreeMotion& body = *problem_.free_bodies[k];
    RigidMotionState& state = motion_[origin_.size() + k];
    const auto own = velocity.segment(body.centre_node() * d, 2 * d);
    state.velocity.head(d) = own.head(d);
    state.spin.tail(body.gyration().size()) = body.angular_velocity(displacement, velocity);
    state.kinetic_energy = state.rigid_kinetic_energy = 0.5 * body.inertia().mass * own.squaredNorm();
  }
  return motion_;
}

}  // namespace ricochet
