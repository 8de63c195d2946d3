#include "ricochet/problem/semidiscrete_problem.hpp"

namespace ricochet {

void SemidiscreteProblem::gaps(const Vector& displacement, Vector& gap) const {
  gap.noalias() = contact.gap_operator * displacement;
  gap += contact.initial_gap;
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

void finish_problem(SemidiscreteProblem& problem, bool mass_without_contact_inertia) {
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
}

}  // namespace ricochet
