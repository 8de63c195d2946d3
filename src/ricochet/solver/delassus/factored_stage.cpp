#include "ricochet/solver/delassus/factored_stage.hpp"

#include <stdexcept>

#include "ricochet/solver/stage/stage_operator.hpp"

namespace ricochet {

namespace {

/// Returns the completed factor.
SparseCholesky factorized(SparseCholesky factor, const SemidiscreteProblem& problem,
                          const OperatorCoefficients& coefficients, const std::vector<int>& dofs) {
  factor.factorize();
  if (!factor.positive_definite()) refuse_operator(problem, coefficients, dofs[std::size_t(factor.failed_unknown())]);
  return factor;
}

}  // namespace

FactoredStage::FactoredStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                             const std::vector<int>& dofs, SparseCholesky factor, SharedContact& shared,
                             FactoredStage* condensed_stage)
    : shared_(shared),
      factor_(factorized(std::move(factor), problem, coefficients, dofs)),
      contact_(problem, number_dofs(problem, dofs), factor_, shared,
               condensed_stage != nullptr
                   ? std::make_unique<MasslessContactNodes>(problem, coefficients, *condensed_stage)
                   : nullptr) {
  dof_at_.reserve(dofs.size());
  for (const int unknown : factor_.permutation()) dof_at_.push_back(dofs[std::size_t(unknown)]);
  factor_vector_.setZero(factor_.work_size());
  shared_.factor_entries += factor_.factor_entries();
}

void FactoredStage::refactorize(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                const SparseMatrix& matrix) {
  factor_.refactorize(matrix);
  if (!factor_.positive_definite()) {
    std::vector<int> dofs(dof_at_.size());
    for (std::size_t i = 0; i < dof_at_.size(); ++i) dofs[std::size_t(factor_.permutation()[i])] = dof_at_[i];
    refuse_operator(problem, coefficients, dofs[std::size_t(factor_.failed_unknown())]);
  }
  contact_.invalidate_columns();
}

/// Computes y = L⁻¹P 2ᵏ b, y += Yρ, δ = Pᵀ L⁻ᵀ y; repeated with more contact points if others have penetrated.
void FactoredStage::solve(const LinearStage& stage, const Vector& right_hand_side, StageSolution& solution,
                          Vector& increment) {
  if (!factor_.positive_definite()) throw std::logic_error("a stage is solved although its operator was refused");
  const double scale = factor_.scale();
  do {
    for (std::size_t i = 0; i < dof_at_.size(); ++i) factor_vector_[Index(i)] = scale * right_hand_side[dof_at_[i]];
    factor_.solve_lower(factor_vector_);
    contact_.solve(stage, factor_vector_, solution);
    factor_.solve_upper(factor_vector_);
    for (std::size_t i = 0; i < dof_at_.size(); ++i) increment[dof_at_[i]] = factor_vector_[Index(i)];
  } while (contact_.add_penetrating(stage, increment, solution));
}

}  // namespace ricochet
