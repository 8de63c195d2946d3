#include "ricochet/problem/semidiscrete_problem.hpp"

#include <algorithm>
#include <limits>

namespace ricochet {

namespace {

/// Subtracts n·s(t) from gaps. `pair` and `normals` are per contact point or per node.
void subtract_translation(const std::vector<const Obstacle*>& obstacles, const std::vector<int>& pair,
                          const Points& normals, double time, Vector& gap) {
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (obstacles[k] == nullptr || !obstacles[k]->moves()) continue;
    if (!obstacles[k]->has_constant_normals()) continue;  // the geometry computes its gaps
    const SpaceVector translation = obstacles[k]->translation(time);
    for (Index i = 0; i < gap.size(); ++i) {
      if (pair[std::size_t(i)] == int(k)) gap[i] -= normals.col(i).dot(translation);
    }
  }
}

}  // namespace

bool SemidiscreteProblem::has_rotating_obstacles() const {
  return std::ranges::any_of(obstacles, [](const Obstacle* obstacle) {
    return obstacle != nullptr && (obstacle->rotates() || obstacle->spins());
  });
}

bool SemidiscreteProblem::has_moving_obstacles() const {
  return std::ranges::any_of(obstacles,
                             [](const Obstacle* obstacle) { return obstacle != nullptr && obstacle->moves(); });
}

void SemidiscreteProblem::gaps(const Vector& displacement, double time, Vector& gap) const {
  contact.rows->normal_motion(displacement, gap);
  gap += contact.initial_gap;
  subtract_translation(obstacles, contact.pair, contact.rows->normals, time, gap);
  if (contact.follows_motion()) contact.geometry->gaps(displacement, time, gap);
}

void SemidiscreteProblem::node_gaps(const Vector& displacement, double time, Vector& gap) const {
  gap.resize(contact.node_initial_gap.size());
  for (Index i = 0; i < gap.size(); ++i) {
    const Index first = contact.nodes[std::size_t(i)] * dimension;
    gap[i] = contact.node_initial_gap[i] + contact.node_normals.col(i).dot(displacement.segment(first, dimension));
  }
  for (Index i = 0; i < contact.opposite_projection.rows(); ++i) {
    for (SparseRowMatrix::InnerIterator entry(contact.opposite_projection, i); entry; ++entry)
      gap[i] -= entry.value() *
                contact.node_normals.col(i).dot(displacement.segment(Index{entry.col()} * dimension, dimension));
  }
  subtract_translation(obstacles, contact.node_pair, contact.node_normals, time, gap);
  if (contact.follows_motion()) contact.geometry->node_gaps(displacement, time, gap);
}

SpaceVector SemidiscreteProblem::node_normal(Index entry, const Vector& displacement, double time) const {
  if (contact.follows_motion()) return contact.geometry->node_normal(entry, displacement, time);
  return contact.node_normals.col(entry);
}

/// Current position of a contact point at an obstacle, where t = c.
SpaceVector SemidiscreteProblem::position(Index point, const Vector& displacement) const {
  SpaceVector result = SpaceVector::Zero(dimension);
  contact.visit_nodes(point, [&](Index node, double weight) {
    result += weight * (nodes.col(node) + displacement.segment(node * dimension, dimension));
  });
  return result;
}

void SemidiscreteProblem::obstacle_velocity(const Vector& displacement, double time, double span,
                                            ObstacleMotion& velocity) const {
  if (!has_moving_obstacles()) return;
  const int tangents = dimension - 1;
  const ContactRows& rows = *contact.rows;
  velocity.normal.setZero(contact.size());
  velocity.tangential.setZero(contact.size() * tangents);
  if (contact.follows_motion()) velocity.in_space.setZero(dimension, contact.size());
  for (Index i = 0; i < contact.size(); ++i) {
    const Obstacle* const moving = obstacle_of_point(i);
    if (moving == nullptr || !moving->moves()) continue;
    const SpaceVector at = moving->surface_velocity(position(i, displacement), time, span);
    if (contact.follows_motion()) velocity.in_space.col(i) = at;
    velocity.normal[i] = rows.normals.col(i).dot(at);
    for (int k = 0; k < tangents; ++k) {
      const Index row = i * tangents + k;
      if (rows.slips[std::size_t(row)] == 0) continue;
      velocity.tangential[row] = rows.tangents[std::size_t(i)].col(k).dot(at);
    }
  }
}

void SemidiscreteProblem::trace_rounding(const Vector& values, Vector& rounding) const {
  rounding.resize(contact.size());
  for (Index i = 0; i < contact.size(); ++i) {
    double sum = 0.0;
    contact.visit_nodes(i, [&](Index node, double weight) {
      sum += std::abs(weight) * values.segment(node * dimension, dimension).lpNorm<1>();
    });
    rounding[i] = 8.0 * std::numeric_limits<double>::epsilon() * sum;
  }
}

void SemidiscreteProblem::gather_contact(const Vector& values, Eigen::Ref<Vector> on_contact) const {
  for (std::size_t i = 0; i < contact_dofs.size(); ++i) on_contact[Index(i)] = values[contact_dofs[i]];
}

void SemidiscreteProblem::scatter_contact(const Eigen::Ref<const Vector>& on_contact, Vector& values) const {
  for (std::size_t i = 0; i < contact_dofs.size(); ++i) values[contact_dofs[i]] = on_contact[Index(i)];
}

std::shared_ptr<const InternalForce> SemidiscreteProblem::internal_force_at_contact() const {
  if (contact_dofs.empty()) return nullptr;
  std::vector<char> selected(static_cast<std::size_t>(nodes.cols()), 0);
  for (const Index dof : contact_dofs) selected[std::size_t(dof / dimension)] = 1;
  return internal_force->restricted_to(selected);
}

std::vector<Index> contact_node_dofs(const SemidiscreteProblem& problem) {
  std::vector<Index> dofs;
  for (const Index node : problem.contact.unique_nodes()) {
    for (int k = 0; k < problem.dimension; ++k) dofs.push_back(node * problem.dimension + k);
  }
  return dofs;
}

void finish_problem(SemidiscreteProblem& problem, const SparseMatrix& mass, bool mass_without_contact_inertia) {
  problem.is_massless.assign(std::size_t(problem.dof_count()), 0);
  problem.massless_dofs.clear();
  problem.contact_dofs.clear();
  for (const Index dof : contact_node_dofs(problem)) {
    if (!problem.supports.contains(dof)) problem.contact_dofs.push_back(dof);
    if (!mass_without_contact_inertia) continue;
    problem.massless_dofs.push_back(dof);
    problem.is_massless[std::size_t(dof)] = 1;
  }
  problem.mass = NodeMatrix(mass, problem.dimension);
}

}  // namespace ricochet
