#include "ricochet/simulation/statics/held_bodies.hpp"

#include <algorithm>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/linear_algebra/graph_components.hpp"

namespace ricochet {

namespace {

/// RᵀR of the rigid motions R of a body at its supported dofs, in units of its size. All ranks call it together.
Matrix square_of_supported_motions(const SemidiscreteProblem& problem, const std::vector<Index>& members) {
  const Index d = problem.dimension;
  const Ranks& ranks = *problem.ranks;
  Vector sum = Vector::Zero(d + 1);
  for (const Index node : members) {
    if (!ranks.is_owned(node)) continue;
    sum.head(d) += problem.nodes.col(node);
    sum[d] += 1.0;
  }
  ranks.sum({sum.data(), std::size_t(sum.size())});
  const Vector centre = sum.head(d) / sum[d];
  double size = 0.0;
  for (const Index node : members) size = std::max(size, (problem.nodes.col(node) - centre).norm());
  size = ranks.maximum(size);
  Matrix result = Matrix::Zero(problem.axisymmetric ? 1 : d == 2 ? 3 : 6, problem.axisymmetric ? 1 : d == 2 ? 3 : 6);
  for (const Index node : members) {
    if (!ranks.is_owned(node)) continue;
    Eigen::Vector3d arm = Eigen::Vector3d::Zero();
    arm.head(d) = (problem.nodes.col(node) - centre) / size;
    for (Index k = 0; k < d; ++k) {
      if (!problem.supports.contains(node * d + k)) continue;
      const Eigen::Vector3d moment = arm.cross(Eigen::Vector3d::Unit(k));
      Vector row = Vector::Zero(d == 2 ? 3 : 6);
      row[k] = 1.0;
      d == 2 ? void(row[2] = moment[2]) : void(row.tail(3) = moment);
      if (problem.axisymmetric) row = row.segment(1, 1).eval();
      result += row * row.transpose();
    }
  }
  ranks.sum({result.data(), std::size_t(result.size())});
  return result;
}

}  // namespace

bool are_fixed_by_supports(const SemidiscreteProblem& problem, const std::vector<Index>& members) {
  constexpr double negligible = 1e-8;
  const Vector sizes = symmetric_eigenvalues(square_of_supported_motions(problem, members));
  return sizes[0] > negligible * sizes[sizes.size() - 1];
}

bool all_are_fixed_by_supports(const SemidiscreteProblem& problem) {
  for (const std::vector<Index>& members : graph_components(problem.internal_force->graph(problem.dimension))) {
    if (members.size() == 1 && problem.is_tied_dof(members.front() * problem.dimension)) continue;
    if (!are_fixed_by_supports(problem, members)) return false;
  }
  return true;
}

bool are_fixed_at_rest(const SemidiscreteProblem& problem, const std::vector<Index>& members) {
  const Index d = problem.dimension;
  bool moves = false;
  for (const Index node : members) {
    for (Index dof = node * d; dof < (node + 1) * d; ++dof)
      moves = moves || (problem.supports.contains(dof) && problem.supports.expression(dof).depends_on_time());
  }
  if (problem.ranks->any(moves)) return false;
  return are_fixed_by_supports(problem, members);
}

}  // namespace ricochet
