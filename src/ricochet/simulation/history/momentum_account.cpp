#include "ricochet/simulation/history/momentum_account.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "ricochet/simulation/history/sensor.hpp"

namespace ricochet {

namespace {

/// Extends a vector in the plane by zeros.
template <class Values>
Eigen::Vector3d in_space(const Values& values) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  result.head(values.size()) = values;
  return result;
}

void add(Resultant& sum, const Eigen::Vector3d& position, const Eigen::Vector3d& force) {
  sum.force += force;
  sum.moment += position.cross(force);
}

}  // namespace

MomentumAccount::MomentumAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state)
    : problem_(problem),
      scheme_(scheme),
      rule_(scheme.traits().work_rule),
      couples_(problem),
      finite_strain_(!problem.internal_force->is_linear()),
      positions_(problem.nodes) {
  if (positions_change()) displacement_before_ = state.displacement;
  update_positions(state.displacement);
  previous_ = resultant(state.forces);
  algorithmic_ = algorithmic(state);
  force_.setZero(problem.dof_count());
  problem.internal_force->add_ground_force(Vector::Ones(problem.dof_count()), force_);
  has_springs_ = !force_.isZero(0.0);
}

void MomentumAccount::update_positions(const Vector& displacement) {
  if (finite_strain_) positions_ = problem_.nodes + displacement.reshaped(problem_.dimension, problem_.nodes.cols());
  // Rigid bodies have their current positions, also at small strain of the others.
  for (const auto& body : problem_.free_bodies) {
    positions_.col(body->centre_node()) = body->centre(displacement);
    positions_.col(body->rotation_node()).setZero();
  }
  arm_ = std::max(arm_, problem_.ranks->maximum(positions_.colwise().norm().maxCoeff()));
  constant_load_ = of_nodes(problem_.loads.constant());
}

/// Part of the momentum beside M V, divided by h.
Resultant MomentumAccount::algorithmic(const State& state) {
  if (!scheme_.momentum_acceleration(state, acceleration_)) return {};
  problem_.mass.multiply(acceleration_, momentum_);
  return of_nodes(momentum_);
}

/// The resultant at the end of the last step is saved, as it is about positions that the state does not contain.
void MomentumAccount::persist(const SnapshotVisitor& visit) {
  visit.numbers("", impulse_, size_, previous_.total, previous_.size, algorithmic_, arm_, contact_size_,
                previous_.contact_size);
}

Resultant MomentumAccount::part_of_nodes(const Vector& force) const {
  const Index d = problem_.dimension;
  Resultant result;
  for (Index node = 0; node < problem_.nodes.cols(); ++node) {
    if (problem_.is_rotation_node(node)) continue;
    add(result, in_space(positions_.col(node)), in_space(force.segment(node * d, d)));
  }
  for (const auto& body : problem_.free_bodies) {
    const SpaceVector torque = body->torque(force);
    result.moment.tail(torque.size()) += torque;
  }
  return result;
}

Resultant MomentumAccount::of_nodes(const Vector& force) const {
  Resultant result = part_of_nodes(force);
  add_up_ranks({&result, 1});
  return result;
}

/// Uses one exchange for all parts.
void MomentumAccount::add_up_ranks(std::span<Resultant> parts) const {
  if (!problem_.ranks->are_several()) return;
  std::array<double, 6 * most_parts> numbers{};
  const auto at = [&numbers](std::size_t i) { return Eigen::Map<Eigen::Vector3d>(numbers.data() + 3 * i); };
  for (std::size_t i = 0; i < parts.size(); ++i) {
    at(2 * i) = parts[i].force;
    at(2 * i + 1) = parts[i].moment;
  }
  problem_.ranks->sum({numbers.data(), 6 * parts.size()});
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = {at(2 * i), at(2 * i + 1)};
}

/// The force of such a point has the entries of all its rows and is summed node by node: between bodies at finite
/// strain, where it acts at the positions of the nodes (rotating_pairs.hpp), and at rigid bodies.
bool MomentumAccount::is_summed_by_nodes(Index point) const {
  if (problem_.contact.between_bodies(point)) return finite_strain_ || problem_.contact.slides(point);
  return !problem_.free_bodies.empty() && problem_.obstacle_of_point(point)->free_motion() != nullptr;
}

/// Resultant of the points that are summed node by node.
Resultant MomentumAccount::between_bodies(const StepForces& forces) {
  normal_ = forces.acting_normal();
  tangential_ = forces.acting_tangential();
  const Index tangents = problem_.dimension - 1;
  for (Index i = 0; i < normal_.size(); ++i) {
    if (is_summed_by_nodes(i)) continue;
    normal_[i] = 0.0;
    if (tangential_.size() > 0) tangential_.segment(i * tangents, tangents).setZero();
  }
  force_.setZero(problem_.dof_count());
  forces.rows->add_force(normal_, tangential_, force_);
  // Before the first step no force has acted at any position.
  const LastStep last = scheme_.last_step();
  const Vector* const position_of_forces = last.has_couples_between_bodies ? last.displacement_of_forces : nullptr;
  if (position_of_forces != nullptr && position_of_forces->size() == problem_.dof_count())
    couples_.add(*position_of_forces, *forces.rows, normal_, tangential_, force_);
  return part_of_nodes(force_);
}

MomentumAccount::Sum MomentumAccount::resultant(const StepForces& forces) {
  const Index d = problem_.dimension;
  Sum sum;
  const auto include = [&sum](const Resultant& part, double sign = 1.0) {
    sum.total.force += sign * part.force;
    sum.total.moment += sign * part.moment;
    sum.size += part.force.norm();
  };
  std::array<Resultant, most_parts> parts;
  Resultant &contact = parts[0], &supports = parts[1], &magnitudes = parts[4];
  bool presses_bodies = false;
  for (Index i = 0; i < forces.acting_normal().size(); ++i) {
    // Under Tresca's law a point without pressure may still carry friction.
    if (!carries_acting_force(forces, i)) continue;
    const Eigen::Vector3d force = in_space(acting_contact_force(forces, i));
    magnitudes.force[1] += force.norm();
    if (is_summed_by_nodes(i)) {
      presses_bodies = true;
      continue;
    }
    // Between bodies the moment of forces that do not act along the gap is the only remainder.
    contact.force += problem_.contact.net[i] * force;
    contact.moment += in_space(problem_.contact.arm(i, positions_)).cross(force);
  }
  if (presses_bodies) {
    const Resultant left = between_bodies(forces);
    contact.force += left.force;
    contact.moment += left.moment;
  }
  for (Index i = 0; i < forces.support_reaction.size(); ++i) {
    const Index dof = problem_.supports.dofs()[std::size_t(i)];
    if (!problem_.is_rotation_node(dof / d))
      add(supports, in_space(positions_.col(dof / d)), forces.support_reaction[i] * Eigen::Vector3d::Unit(dof % d));
    magnitudes.force[0] += std::abs(forces.support_reaction[i]);
  }
  for (const auto& body : problem_.free_bodies)
    supports.moment.tail(body->gyration().size()) += support_torque(*body, forces);
  const bool varies = forces.varying_load.size() > 0, is_damped = forces.damping_force.size() > 0;
  if (varies) parts[2] = part_of_nodes(forces.varying_load);
  if (is_damped) parts[3] = part_of_nodes(forces.damping_force);
  add_up_ranks(parts);
  include(contact);
  include(supports);
  sum.size += magnitudes.force[0];
  sum.contact_size = magnitudes.force[1];
  if (varies) include(parts[2]);
  if (is_damped) include(parts[3], -1.0);
  return sum;
}

/// Torque that holds the rotation of a rigid body.
SpaceVector MomentumAccount::support_torque(const FreeMotion& body, const StepForces& forces) {
  const Index first = body.rotation_node() * problem_.dimension;
  force_.setZero(problem_.dof_count());
  for (Index i = 0; i < forces.support_reaction.size(); ++i) {
    const Index dof = problem_.supports.dofs()[std::size_t(i)];
    if (dof >= first && dof < first + problem_.dimension) force_[dof] = forces.support_reaction[i];
  }
  return body.torque(force_);
}

/// Springs between rigid bodies and the ground: their force is linear in the displacement, so that its mean over the
/// step is that of its ends.
MomentumAccount::Sum MomentumAccount::of_springs() {
  force_.setZero(problem_.dof_count());
  problem_.internal_force->add_ground_force(mean_, force_);
  force_ = -force_;
  Sum sum;
  sum.total = of_nodes(force_);
  sum.size = sum.total.force.norm();
  return sum;
}

void MomentumAccount::add_impulse(double weight, const Resultant& resultant) {
  if (problem_.axisymmetric) {
    impulse_.force[1] += weight * resultant.force[1];
    return;
  }
  impulse_.force += weight * resultant.force;
  impulse_.moment += weight * resultant.moment;
}

void MomentumAccount::enter_impulse(const State& state, const Vector& impulse) {
  if (positions_change()) update_positions(state.displacement);
  const Resultant sum = of_nodes(impulse);
  add_impulse(1.0, sum);
  size_ += sum.force.norm();
}

void MomentumAccount::enter_step(const State& state) {
  const auto enter = [this](const Sum& sum, double weight) {
    add_impulse(scheme_.step() * weight, sum.total);
    size_ += scheme_.step() * weight * sum.size;
    contact_size_ += scheme_.step() * weight * sum.contact_size;
  };
  const Resultant load_before = constant_load_;
  bool at_both_ends = false;
  if (positions_change()) {
    if (has_springs_) mean_ = 0.5 * (displacement_before_ + state.displacement);
    const Vector* const of_scheme = scheme_.last_step().displacement_of_forces;
    at_both_ends = of_scheme != nullptr && rule_.previous_weight != 0.0;
    if (of_scheme != nullptr) {
      displacement_of_forces_ = *of_scheme;
    } else {
      displacement_of_forces_ = 0.5 * (displacement_before_ + state.displacement);
    }
    update_positions(displacement_of_forces_);
    displacement_before_ = state.displacement;
  }
  if (at_both_ends) {
    enter({load_before, load_before.force.norm()}, rule_.previous_weight);
    enter({constant_load_, constant_load_.force.norm()}, rule_.current_weight);
  } else {
    enter({constant_load_, constant_load_.force.norm()}, 1.0);
  }
  if (has_springs_) enter(of_springs(), 1.0);
  const Sum current = resultant(state.forces);
  if (rule_.previous_weight != 0.0) enter(previous_, rule_.previous_weight);
  enter(current, rule_.current_weight);
  for (const OtherStageForces& part : scheme_.last_step().other_stages) enter(resultant(part.forces), part.weight);
  previous_ = current;
  const Resultant now = algorithmic(state);
  add_impulse(-scheme_.step(), {now.force - algorithmic_.force, now.moment - algorithmic_.moment});
  algorithmic_ = now;
}

}  // namespace ricochet
