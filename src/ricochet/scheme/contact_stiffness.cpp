#include "ricochet/scheme/contact_stiffness.hpp"

#include <vector>

namespace ricochet {

void ContactStiffness::analyse(const SemidiscreteProblem& problem, double stiffness, double damping) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](const SparseMatrix& matrix, double factor) {
    for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i) {
      for (SparseMatrix::InnerIterator entry(matrix, problem.contact_dofs[i]); entry; ++entry)
        entries.emplace_back(int(i), int(entry.row()), factor * entry.value());
    }
  };
  if (stiffness != 0.0) add(problem.internal_force->tangent(), stiffness);
  if (damping != 0.0 && problem.has_damping()) add(problem.damping.matrix(), damping);
  rows_.resize(Index(problem.contact_dofs.size()), problem.dof_count());
  rows_.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace ricochet
