#include "ricochet/solver/delassus/direct_stage.hpp"

#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/delassus/factored_stage.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"

namespace ricochet {

namespace {

/// Restricts A to some dofs; empties `matrix` if these are all.
SparseMatrix on_dofs(const SemidiscreteProblem& problem, const std::vector<int>& dofs, SparseMatrix& matrix) {
  const auto count = Index(dofs.size());
  SparseMatrix result;
  if (count == problem.dof_count()) {
    result.swap(matrix);
  } else {
    const std::vector<int> number = number_dofs(problem, dofs);
    extract(matrix, number, count, number, count).swap(result);
  }
  return result;
}

/// Stage with a factor of the whole operator. Supports are on the right-hand side.
class DirectStage final : public StageSolver {
 public:
  DirectStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, AnalysedOperator analysed,
              SharedContact& shared, FactoredStage* condensed_stage);

  void solve(const LinearStage& stage, StageSolution& solution) override;
  void refactorize(const Vector& displacement) override;
  void show_contact() const override { stage_.report(); }
  void persist(const SnapshotVisitor& visit) override { stage_.persist(visit); }
  [[nodiscard]] FactoredStage* factored() override { return &stage_; }

 private:
  [[nodiscard]] const Vector& right_hand_side(const LinearStage& stage);

  const SemidiscreteProblem& problem_;
  OperatorCoefficients coefficients_;
  SparseRowMatrix supported_;  ///< A's rows of supported dofs: supports × dofs
  FactoredStage stage_;
  Vector right_hand_side_, contact_force_;
};

DirectStage::DirectStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                         AnalysedOperator analysed, SharedContact& shared, FactoredStage* condensed_stage)
    : problem_(problem),
      coefficients_(coefficients),
      supported_(std::move(analysed.supported)),
      stage_(problem, coefficients, analysed.dofs, std::move(analysed.factor), shared, condensed_stage) {}

void DirectStage::refactorize(const Vector& displacement) {
  SparseMatrix matrix = combine_operator(problem_, coefficients_, displacement);
  supported_ = supported_rows(problem_, matrix);
  stage_.refactorize(problem_, coefficients_, on_dofs(problem_, solved_dofs(problem_, coefficients_.dofs), matrix));
}

/// Computes b − A_fs δ_s.
const Vector& DirectStage::right_hand_side(const LinearStage& stage) {
  if (problem_.supports.size() == 0 || stage.right_hand_side.prescribed.isZero(0.0)) return stage.right_hand_side.force;
  right_hand_side_ = stage.right_hand_side.force;
  right_hand_side_.noalias() -= supported_.transpose() * stage.right_hand_side.prescribed;
  return right_hand_side_;
}

void DirectStage::solve(const LinearStage& stage, StageSolution& solution) {
  solution.iterations = 0;
  // Dofs that are neither solved for nor supported stay zero from the first step on.
  if (solution.increment.size() != problem_.dof_count()) solution.increment.setZero(problem_.dof_count());
  prescribe(problem_, stage, solution.increment);
  stage_.solve(stage, right_hand_side(stage), solution, solution.increment);
  find_support_reaction(problem_, stage, supported_, contact_force_, solution);
}

}  // namespace

AnalysedOperator analyse_operator(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients) {
  AnalysedOperator result;
  result.dofs = solved_dofs(problem, coefficients.dofs);
  SparseMatrix matrix = combine_operator(problem, coefficients);
  result.supported = supported_rows(problem, matrix);
  const SparseMatrix unknown = on_dofs(problem, result.dofs, matrix);
  matrix = SparseMatrix();  // ordering takes memory
  result.factor.analyse(unknown);
  return result;
}

std::unique_ptr<StageSolver> make_direct_stage(const SemidiscreteProblem& problem,
                                               const OperatorCoefficients& coefficients, AnalysedOperator analysed,
                                               SharedContact& shared, FactoredStage* condensed_stage) {
  return std::make_unique<DirectStage>(problem, coefficients, std::move(analysed), shared, condensed_stage);
}

}  // namespace ricochet
