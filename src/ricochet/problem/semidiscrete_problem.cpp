#include "ricochet/problem/semidiscrete_problem.hpp"

#include <algorithm>
#include <limits>

namespace ricochet {

namespace {

/// Subtracts n·s(t) from gaps. `pair` and `normals` are of the points or of the nodes.
void subtract_translation(const std::vector<const Obstacle*>& obstacles, const std::vector<int>& pair,
                          const Points& normals, double time, Vector& gap) {
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (!obstacles[k]->moves()) continue;
    const SpaceVector translation = obstacles[k]->translation(time);
    for (Index i = 0; i < gap.size(); ++i) {
      if (pair[static_cast<std::size_t>(i)] == static_cast<int>(k)) gap[i] -= normals.col(i).dot(translation);
    }
  }
}

}  // namespace

bool SemidiscreteProblem::has_moving_obstacles() const {
  return std::any_of(obstacles.begin(), obstacles.end(), [](const Obstacle* obstacle) { return obstacle->moves(); });
}

void SemidiscreteProblem::gaps(const Vector& displacement, double time, Vector& gap) const {
  gap.noalias() = contact.gap_operator * displacement;
  gap += contact.initial_gap;
  subtract_translation(obstacles, contact.pair, contact.normals, time, gap);
}

void SemidiscreteProblem::node_gaps(const Vector& displacement, double time, Vector& gap) const {
  gap.resize(contact.node_initial_gap.size());
  for (Index i = 0; i < gap.size(); ++i) {
    const Index first = contact.nodes[static_cast<std::size_t>(i)] * dimension;
    gap[i] = contact.node_initial_gap[i] + contact.node_normals.col(i).dot(displacement.segment(first, dimension));
  }
  subtract_translation(obstacles, contact.node_pair, contact.node_normals, time, gap);
}

void SemidiscreteProblem::obstacle_velocity(const Vector& displacement, double time, ObstacleMotion& velocity) const {
  if (!has_moving_obstacles()) return;
  const int tangents = dimension - 1;
  velocity.normal.setZero(contact.size());
  velocity.tangential.setZero(contact.size() * tangents);
  SpaceVector position(dimension);
  for (Index i = 0; i < contact.size(); ++i) {
    const Obstacle& obstacle = *obstacle_of_point(i);
    if (!obstacle.moves()) continue;
    position.setZero();
    for (SparseRowMatrix::InnerIterator entry(contact.trace, i); entry; ++entry) {
      position += entry.value() * (nodes.col(entry.col()) + displacement.segment(entry.col() * dimension, dimension));
    }
    const SpaceVector at = obstacle.surface_velocity(position, time);
    velocity.normal[i] = contact.normals.col(i).dot(at);
    for (int k = 0; k < tangents; ++k) {
      const Index row = i * tangents + k;
      // Rows of B_T that are zero belong to directions in which supports hold the body: no slip is defined there.
      if (contact.tangential_trace.row(row).nonZeros() == 0) continue;
      velocity.tangential[row] = contact.tangents[static_cast<std::size_t>(i)].col(k).dot(at);
    }
  }
}

void SemidiscreteProblem::trace_rounding(const Vector& values, Vector& rounding) const {
  rounding.resize(contact.size());
  for (Index i = 0; i < contact.size(); ++i) {
    double sum = 0.0;
    for (SparseRowMatrix::InnerIterator entry(contact.trace, i); entry; ++entry) {
      sum += std::abs(entry.value()) * values.segment(entry.col() * dimension, dimension).lpNorm<1>();
    }
    rounding[i] = 8.0 * std::numeric_limits<double>::epsilon() * sum;
  }
}

void SemidiscreteProblem::add_contact_force(const Vector& normal, const Vector& tangential, Vector& force) const {
  // Row by row: few points carry a force, and nothing is allocated.
  for (Index i = 0; i < normal.size(); ++i) {
    if (normal[i] == 0.0) continue;
    for (SparseRowMatrix::InnerIterator entry(contact.gap_operator, i); entry; ++entry) {
      force[entry.col()] += entry.value() * normal[i];
    }
  }
  for (Index i = 0; i < tangential.size(); ++i) {
    if (tangential[i] == 0.0) continue;
    for (SparseRowMatrix::InnerIterator entry(contact.tangential_trace, i); entry; ++entry) {
      force[entry.col()] -= entry.value() * tangential[i];
    }
  }
}

void finish_problem(SemidiscreteProblem& problem, const SparseMatrix& mass, bool mass_without_contact_inertia) {
  problem.is_massless.assign(static_cast<std::size_t>(problem.dof_count()), 0);
  problem.massless_dofs.clear();
  problem.contact_dofs.clear();
  for (const Index node : problem.contact.unique_nodes()) {
    for (int k = 0; k < problem.dimension; ++k) {
      const Index dof = node * problem.dimension + k;
      if (!problem.supports.contains(dof)) problem.contact_dofs.push_back(dof);
      if (!mass_without_contact_inertia) continue;
      problem.massless_dofs.push_back(dof);
      problem.is_massless[static_cast<std::size_t>(dof)] = 1;
    }
  }
  problem.mass = NodeMatrix(mass, problem.dimension);
}

}  // namespace ricochet
