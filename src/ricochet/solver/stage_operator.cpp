#include "ricochet/solver/stage_operator.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"

namespace ricochet {

SparseMatrix combine_operator(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients) {
  SparseMatrix result = coefficients.stiffness * problem.internal_force->tangent();
  if (coefficients.mass != 0.0) result = SparseMatrix(result + coefficients.mass * problem.mass);
  if (coefficients.damping != 0.0 && problem.has_damping()) {
    result = SparseMatrix(result + coefficients.damping * problem.damping);
  }
  if (coefficients.stiffness == 0.0) result.prune(0.0, 0.0);
  return result;
}

std::vector<int> solved_dofs(const SemidiscreteProblem& problem, StageDofs dofs) {
  const auto solved_for = [&](Index dof) {
    if (problem.supports.contains(dof)) return false;
    if (dofs == StageDofs::massive) return problem.is_massless[static_cast<std::size_t>(dof)] == 0;
    if (dofs == StageDofs::contact)
      return std::binary_search(problem.contact_dofs.begin(), problem.contact_dofs.end(), dof);
    return true;
  };
  std::vector<int> result;
  for (Index dof = 0; dof < problem.dof_count(); ++dof) {
    if (solved_for(dof)) result.push_back(static_cast<int>(dof));
  }
  return result;
}

std::vector<int> number_dofs(const SemidiscreteProblem& problem, const std::vector<int>& dofs) {
  std::vector<int> number(static_cast<std::size_t>(problem.dof_count()), -1);
  for (std::size_t i = 0; i < dofs.size(); ++i) number[static_cast<std::size_t>(dofs[i])] = static_cast<int>(i);
  return number;
}

void refuse_operator(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, Index dof) {
  const Vector at = problem.nodes.col(dof / problem.dimension);
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("the operator {:g} M + {:g} K is not positive definite (Cholesky stops at component {} of the "
                  "node at ({:.6g}, {:.6g}{})): a region may be without mass or free to move without "
                  "resistance, or material data may differ by too many orders of magnitude",
                  coefficients.mass, coefficients.stiffness, "xyz"[dof % problem.dimension], at[0], at[1],
                  at.size() == 3 ? fmt::format(", {:.6g}", at[2]) : ""));
}

}  // namespace ricochet
