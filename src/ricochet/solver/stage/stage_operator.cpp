#include "ricochet/solver/stage/stage_operator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/problem/viscous_force.hpp"

namespace ricochet {

SparseMatrix stage_stiffness(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                             const Vector& displacement) {
  const ViscousForce* const viscous = problem.internal_force->viscous();
  SparseMatrix stiffness = viscous != nullptr ? viscous->step_tangent(displacement, coefficients.relaxation_step)
                                              : problem.internal_force->tangent(displacement);
  if (!problem.pressure || displacement.size() == 0) return stiffness;
  return add_sparse(stiffness, problem.pressure->stiffness(displacement));
}

SparseMatrix combine_operator(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                              const Vector& displacement) {
  SparseMatrix result;
  const auto add = [&](double factor, const auto& matrix) {
    if (factor == 0.0) return;
    SparseMatrix term = matrix();
    term *= factor;
    if (result.cols() > 0) add_sparse(result, term).swap(term);
    result.swap(term);
  };
  add(coefficients.stiffness, [&] { return stage_stiffness(problem, coefficients, displacement); });
  add(coefficients.mass, [&] { return problem.mass.to_sparse(); });
  if (problem.has_damping()) add(coefficients.damping, [&] { return problem.damping.matrix(); });
  return result;
}

std::vector<int> solved_dofs(const SemidiscreteProblem& problem, StageDofs dofs) {
  const auto solved_for = [&](Index dof) {
    if (problem.supports.contains(dof) || problem.is_tied_dof(dof)) return false;
    if (dofs == StageDofs::massive) return problem.is_massless[std::size_t(dof)] == 0;
    if (dofs == StageDofs::contact) return std::ranges::binary_search(problem.contact_dofs, dof);
    return true;
  };
  std::vector<int> result;
  for (Index dof = 0; dof < problem.dof_count(); ++dof) {
    if (solved_for(dof)) result.push_back(int(dof));
  }
  return result;
}

SparseRowMatrix supported_rows(const SemidiscreteProblem& problem, const SparseMatrix& matrix) {
  std::vector<int> every(static_cast<std::size_t>(problem.dof_count())), support(every.size(), -1);
  std::iota(every.begin(), every.end(), 0);
  for (Index i = 0; i < problem.supports.size(); ++i)
    support[std::size_t(problem.supports.dofs()[std::size_t(i)])] = int(i);
  return extract(matrix, support, problem.supports.size(), every, problem.dof_count());
}

void find_support_reaction(const SemidiscreteProblem& problem, const LinearStage& stage,
                           const SparseRowMatrix& supported, Vector& contact_force, StageSolution& solution) {
  Vector& reaction = solution.support_reaction;
  reaction.resize(problem.supports.size());
  if (reaction.size() == 0) return;
  contact_force.setZero(problem.dof_count());
  stage.rows.add_force(solution.acting_normal(), solution.acting_tangential(), contact_force);
  reaction.noalias() = supported * solution.increment;
  for (Index i = 0; i < reaction.size(); ++i) {
    const Index dof = problem.supports.dofs()[std::size_t(i)];
    reaction[i] = reaction[i] - stage.right_hand_side.force[dof] - contact_force[dof];
  }
}

void prescribe(const SemidiscreteProblem& problem, const LinearStage& stage, Vector& increment) {
  const std::vector<Index>& supported = problem.supports.dofs();
  for (std::size_t i = 0; i < supported.size(); ++i)
    increment[supported[i]] = stage.right_hand_side.prescribed[Index(i)];
}

std::vector<int> number_dofs(const SemidiscreteProblem& problem, const std::vector<int>& dofs) {
  std::vector<int> number(static_cast<std::size_t>(problem.dof_count()), -1);
  for (std::size_t i = 0; i < dofs.size(); ++i) number[std::size_t(dofs[i])] = int(i);
  return number;
}

void refuse_operator(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, Index dof) {
  const Vector at = problem.nodes.col(dof / problem.dimension);
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("the operator {:g} M + {:g} K is not positive definite (Cholesky stops at component {} of the "
                  "node at ({:.6g}, {:.6g}{})): a region may be without mass or free to move without "
                  "resistance, material data may differ by too many orders of magnitude, or time.step may be far too "
                  "long",
                  coefficients.mass, coefficients.stiffness, "xyz"[dof % problem.dimension], at[0], at[1],
                  at.size() == 3 ? fmt::format(", {:.6g}", at[2]) : ""));
}

}  // namespace ricochet
