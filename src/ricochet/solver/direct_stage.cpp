#include <fmt/format.h>

#include <numeric>

#include "ricochet/solver/condensed_contact.hpp"
#include "ricochet/solver/stage_operator.hpp"
#include "ricochet/solver/stage_solver.hpp"

namespace ricochet {

namespace {

/// Everything that is constant for the stages of one operator: forward solve, condensed contact, back solve.
class DirectStage final : public StageSolver {
 public:
  DirectStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, AnalysedOperator analysed,
              const StepSolverOptions& options);

  void solve(const Stage& stage, StageSolution& solution) override;
  void observe_contact(const ContactObserver& observer) override { contact_->observe(observer); }
  [[nodiscard]] double contact_seconds() const override { return contact_->solver_seconds(); }
  [[nodiscard]] std::size_t factor_entries() const override { return factor_.factor_entries(); }

 private:
  void solve_free(const Stage& stage);
  void give_increment(const Stage& stage, Vector& increment) const;
  void recover_support_reaction(const Stage& stage, StageSolution& solution);

  const SemidiscreteProblem& problem_;
  std::vector<int> dof_at_;    ///< per place in the factor
  SparseRowMatrix supported_;  ///< A's rows of supported dofs: supports × dofs
  SparseCholesky factor_;
  std::unique_ptr<CondensedContact> contact_;
  Vector factor_vector_, right_hand_side_, supported_force_, contact_force_;
};

DirectStage::DirectStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                         AnalysedOperator analysed, const StepSolverOptions& options)
    : problem_(problem), supported_(std::move(analysed.supported)), factor_(std::move(analysed.factor)) {
  factor_.factorize(std::move(analysed.matrix));
  const std::vector<int>& dofs = analysed.dofs;
  if (!factor_.positive_definite())
    refuse_operator(problem, coefficients, dofs[static_cast<std::size_t>(factor_.failed_unknown())]);
  for (const int unknown : factor_.permutation()) dof_at_.push_back(dofs[static_cast<std::size_t>(unknown)]);
  factor_vector_.setZero(factor_.work_size());
  contact_ = std::make_unique<CondensedContact>(problem, number_dofs(problem, dofs), factor_, options.all_points);
}

void DirectStage::recover_support_reaction(const Stage& stage, StageSolution& solution) {
  const std::vector<Index>& dofs = problem_.supports.dofs();
  solution.support_reaction.resize(problem_.supports.size());
  if (dofs.empty()) return;
  contact_force_.setZero(problem_.dof_count());
  problem_.add_contact_force(solution.normal_reaction, solution.tangential_reaction, contact_force_);
  supported_force_.noalias() = supported_ * solution.increment;
  for (Index i = 0; i < problem_.supports.size(); ++i) {
    const Index dof = dofs[static_cast<std::size_t>(i)];
    solution.support_reaction[i] = supported_force_[i] - stage.right_hand_side[dof] - contact_force_[dof];
  }
}

/// y = L⁻¹P 2ᵏ (b − A_fs δ_s).
void DirectStage::solve_free(const Stage& stage) {
  const Vector* right = &stage.right_hand_side;
  if (problem_.supports.size() > 0 && !stage.prescribed.isZero(0.0)) {
    right_hand_side_ = stage.right_hand_side;
    right_hand_side_.noalias() -= supported_.transpose() * stage.prescribed;
    right = &right_hand_side_;
  }
  const double scale = factor_.scale();
  for (std::size_t i = 0; i < dof_at_.size(); ++i) factor_vector_[static_cast<Index>(i)] = scale * (*right)[dof_at_[i]];
  factor_.solve_lower(factor_vector_);
}

void DirectStage::give_increment(const Stage& stage, Vector& increment) const {
  increment.resize(problem_.dof_count());
  if (static_cast<Index>(dof_at_.size()) < problem_.dof_count()) increment.setZero();
  for (std::size_t i = 0; i < dof_at_.size(); ++i) increment[dof_at_[i]] = factor_vector_[static_cast<Index>(i)];
  const std::vector<Index>& supported = problem_.supports.dofs();
  for (std::size_t i = 0; i < supported.size(); ++i) increment[supported[i]] = stage.prescribed[static_cast<Index>(i)];
}

void DirectStage::solve(const Stage& stage, StageSolution& solution) {
  solution.iterations = 0;
  do {
    solve_free(stage);
    contact_->solve(stage, factor_vector_, solution);
    factor_.solve_upper(factor_vector_);
    give_increment(stage, solution.increment);
  } while (contact_->take_up_penetrating(stage, solution.increment));
  contact_->report();
  recover_support_reaction(stage, solution);
}

}  // namespace

AnalysedOperator analyse_operator(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients) {
  AnalysedOperator result;
  result.dofs = solved_dofs(problem, coefficients.dofs);
  SparseMatrix matrix = combine_operator(problem, coefficients);
  std::vector<int> every(static_cast<std::size_t>(problem.dof_count())), support(every.size(), -1);
  std::iota(every.begin(), every.end(), 0);
  for (Index i = 0; i < problem.supports.size(); ++i)
    support[static_cast<std::size_t>(problem.supports.dofs()[static_cast<std::size_t>(i)])] = static_cast<int>(i);
  result.supported = extract(matrix, support, problem.supports.size(), every, problem.dof_count());
  const auto count = static_cast<Index>(result.dofs.size());
  if (count < problem.dof_count()) {
    const std::vector<int> number = number_dofs(problem, result.dofs);
    result.matrix = extract(matrix, number, count, number, count);
  } else {
    result.matrix = std::move(matrix);
  }
  result.factor.analyse(result.matrix);
  return result;
}

std::unique_ptr<StageSolver> make_direct_stage(const SemidiscreteProblem& problem,
                                               const OperatorCoefficients& coefficients, AnalysedOperator analysed,
                                               const StepSolverOptions& options) {
  return std::make_unique<DirectStage>(problem, coefficients, std::move(analysed), options);
}

}  // namespace ricochet
