#include "ricochet/simulation/held_bodies.hpp"

#include <algorithm>

#include "ricochet/base/dense_decompositions.hpp"

namespace ricochet {

namespace {

/// The rigid motions of a body at its supported dofs, in units of its size: supported dofs × motions.
Matrix supported_motions(const SemidiscreteProblem& problem, const std::vector<Index>& members) {
  const Index d = problem.dimension;
  const Points places = problem.nodes(Eigen::all, members);
  const Vector centre = places.rowwise().mean();
  const double size = (places.colwise() - centre).colwise().norm().maxCoeff();
  std::vector<Vector> rows;
  for (const Index node : members) {
    Eigen::Vector3d arm = Eigen::Vector3d::Zero();
    arm.head(d) = (problem.nodes.col(node) - centre) / size;
    for (Index k = 0; k < d; ++k) {
      if (!problem.supports.contains(node * d + k)) continue;
      const Eigen::Vector3d moment = arm.cross(Eigen::Vector3d::Unit(k));
      Vector row = Vector::Zero(d == 2 ? 3 : 6);
      row[k] = 1.0;
      d == 2 ? void(row[2] = moment[2]) : void(row.tail(3) = moment);
      rows.push_back(problem.axisymmetric ? Vector(row.segment(1, 1)) : row);
    }
  }
  Matrix result = Matrix::Zero(static_cast<Index>(rows.size()), problem.axisymmetric ? 1 : d == 2 ? 3 : 6);
  for (std::size_t i = 0; i < rows.size(); ++i) result.row(static_cast<Index>(i)) = rows[i];
  return result;
}

}  // namespace

bool are_held_by_supports(const SemidiscreteProblem& problem, const std::vector<Index>& members) {
  constexpr double negligible = 1e-8;
  const Matrix motions = supported_motions(problem, members);
  const Vector sizes = symmetric_eigenvalues(Matrix(motions.transpose() * motions));
  return sizes[0] > negligible * sizes[sizes.size() - 1];
}

bool are_held_at_rest(const SemidiscreteProblem& problem, const std::vector<Index>& members) {
  const Index d = problem.dimension;
  for (const Index node : members) {
    for (Index dof = node * d; dof < (node + 1) * d; ++dof) {
      if (problem.supports.contains(dof) && problem.supports.expression(dof).depends_on_time()) return false;
    }
  }
  return are_held_by_supports(problem, members);
}

}  // namespace ricochet
