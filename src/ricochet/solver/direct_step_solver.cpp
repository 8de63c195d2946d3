#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/solver/condensed_contact.hpp"
#include "ricochet/solver/step_solver.hpp"

namespace ricochet {

namespace {

/// αM + κK + ηC.
SparseMatrix combine(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients) {
  const SparseMatrix& stiffness = problem.internal_force->tangent();
  SparseMatrix result = coefficients.stiffness * stiffness;
  if (coefficients.mass != 0.0) result = SparseMatrix(result + coefficients.mass * problem.mass);
  if (coefficients.damping != 0.0 && problem.has_damping()) {
    result = SparseMatrix(result + coefficients.damping * problem.damping);
  }
  if (coefficients.stiffness == 0.0) result.prune(0.0, 0.0);
  return result;
}

/// Everything that is constant for the stages of one operator: forward solve, condensed contact, back solve.
class DirectStage {
 public:
  DirectStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients);

  void solve(const Stage& stage, StageSolution& solution);
  void observe_contact(const ContactObserver& observer) { contact_->observe(observer); }
  [[nodiscard]] double contact_seconds() const { return contact_->solver_seconds(); }
  [[nodiscard]] std::size_t factor_entries() const { return factor_->factor_entries(); }

 private:
  void number_dofs(const OperatorCoefficients& coefficients);
  SparseCholesky factorize(const OperatorCoefficients& coefficients);
  void recover_support_reaction(const Stage& stage, StageSolution& solution);

  const SemidiscreteProblem& problem_;
  std::vector<Index> free_dofs_;
  std::vector<int> free_number_;       ///< per dof, −1 where it is not solved for
  std::vector<Index> contact_dofs_;    ///< those solved for, in the factor's order
  std::vector<int> contact_position_;  ///< per dof: its place among them, or −1
  SparseMatrix free_supported_;        ///< A_fs: acts on prescribed increments
  SparseMatrix supported_supported_;   ///< A_ss
  std::unique_ptr<SparseCholesky> factor_;
  std::unique_ptr<CondensedContact> contact_;
  Vector free_right_, factor_vector_, free_increment_, supported_force_, contact_force_;
};

DirectStage::DirectStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients)
    : problem_(problem) {
  number_dofs(coefficients);
  factor_ = std::make_unique<SparseCholesky>(factorize(coefficients));
  contact_ =
      std::make_unique<CondensedContact>(problem, contact_position_, factor_->trailing_factor(), factor_->scale());
}

void DirectStage::number_dofs(const OperatorCoefficients& coefficients) {
  const auto solved_for = [&](Index dof) {
    if (problem_.supports.contains(dof)) return false;
    if (coefficients.dofs == StageDofs::massive) return problem_.is_massless[static_cast<std::size_t>(dof)] == 0;
    if (coefficients.dofs == StageDofs::contact) {
      return std::binary_search(problem_.contact_dofs.begin(), problem_.contact_dofs.end(), dof);
    }
    return true;
  };
  free_number_.assign(static_cast<std::size_t>(problem_.dof_count()), -1);
  for (Index dof = 0; dof < problem_.dof_count(); ++dof) {
    if (!solved_for(dof)) continue;
    free_number_[static_cast<std::size_t>(dof)] = static_cast<int>(free_dofs_.size());
    free_dofs_.push_back(dof);
  }
  // By component: the mass alone does not couple components, and its dense columns then lie side by side.
  contact_position_.assign(static_cast<std::size_t>(problem_.dof_count()), -1);
  for (int component = 0; component < problem_.dimension; ++component) {
    for (const Index dof : problem_.contact_dofs) {
      if (dof % problem_.dimension != component || free_number_[static_cast<std::size_t>(dof)] < 0) continue;
      contact_position_[static_cast<std::size_t>(dof)] = static_cast<int>(contact_dofs_.size());
      contact_dofs_.push_back(dof);
    }
  }
}

SparseCholesky DirectStage::factorize(const OperatorCoefficients& coefficients) {
  const SparseMatrix matrix = combine(problem_, coefficients);
  const auto free_count = static_cast<Index>(free_dofs_.size());
  std::vector<int> supported_number(free_number_.size(), -1);
  for (Index i = 0; i < problem_.supports.size(); ++i) {
    supported_number[static_cast<std::size_t>(problem_.supports.dofs()[static_cast<std::size_t>(i)])] =
        static_cast<int>(i);
  }
  free_supported_ = extract(matrix, free_number_, free_count, supported_number, problem_.supports.size());
  supported_supported_ =
      extract(matrix, supported_number, problem_.supports.size(), supported_number, problem_.supports.size());
  std::vector<Index> trailing;
  for (const Index dof : contact_dofs_) trailing.push_back(free_number_[static_cast<std::size_t>(dof)]);
  SparseCholesky factor(extract(matrix, free_number_, free_count, free_number_, free_count), trailing);
  if (!factor.positive_definite()) {
    const Index dof = free_dofs_[static_cast<std::size_t>(factor.failed_unknown())];
    const Vector at = problem_.nodes.col(dof / problem_.dimension);
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("the operator {:g} M + {:g} K is not positive definite (Cholesky stops at component {} of the "
                    "node at ({:.6g}, {:.6g}{})): a region may be without mass or free to move without resistance, "
                    "or material data may differ by too many orders of magnitude",
                    coefficients.mass, coefficients.stiffness, "xyz"[dof % problem_.dimension], at[0], at[1],
                    at.size() == 3 ? fmt::format(", {:.6g}", at[2]) : ""));
  }
  return factor;
}

void DirectStage::recover_support_reaction(const Stage& stage, StageSolution& solution) {
  const std::vector<Index>& dofs = problem_.supports.dofs();
  solution.support_reaction.resize(problem_.supports.size());
  if (dofs.empty()) return;
  contact_force_.setZero(problem_.dof_count());
  problem_.add_contact_force(solution.normal_reaction, solution.tangential_reaction, contact_force_);
  supported_force_.noalias() = free_supported_.transpose() * free_increment_;
  supported_force_.noalias() += supported_supported_ * stage.prescribed;
  for (Index i = 0; i < problem_.supports.size(); ++i) {
    const Index dof = dofs[static_cast<std::size_t>(i)];
    solution.support_reaction[i] = supported_force_[i] - stage.right_hand_side[dof] - contact_force_[dof];
  }
}

void DirectStage::solve(const Stage& stage, StageSolution& solution) {
  free_right_.resize(static_cast<Index>(free_dofs_.size()));
  for (Index i = 0; i < free_right_.size(); ++i)
    free_right_[i] = stage.right_hand_side[free_dofs_[static_cast<std::size_t>(i)]];
  if (problem_.supports.size() > 0 && !stage.prescribed.isZero(0.0))
    free_right_.noalias() -= free_supported_ * stage.prescribed;
  factor_->forward(free_right_, factor_vector_);
  contact_->solve(stage, factor_vector_.tail(static_cast<Index>(contact_dofs_.size())), solution);
  factor_->backward(factor_vector_, free_increment_);
  solution.increment.setZero(problem_.dof_count());
  for (Index i = 0; i < free_increment_.size(); ++i)
    solution.increment[free_dofs_[static_cast<std::size_t>(i)]] = free_increment_[i];
  for (Index i = 0; i < problem_.supports.size(); ++i) {
    solution.increment[problem_.supports.dofs()[static_cast<std::size_t>(i)]] = stage.prescribed[i];
  }
  recover_support_reaction(stage, solution);
}

class DirectStepSolver final : public StepSolver {
 public:
  DirectStepSolver(const SemidiscreteProblem& problem, const std::vector<OperatorCoefficients>& operators) {
    for (const OperatorCoefficients& coefficients : operators) {
      stages_.push_back(std::make_unique<DirectStage>(problem, coefficients));
    }
  }
  void solve(std::size_t number, const Stage& stage, StageSolution& solution) override {
    stages_.at(number)->solve(stage, solution);
  }
  void observe_contact(const ContactObserver& observer) override {
    for (const auto& stage : stages_) stage->observe_contact(observer);
  }
  [[nodiscard]] double contact_seconds() const override {
    double sum = 0.0;
    for (const auto& stage : stages_) sum += stage->contact_seconds();
    return sum;
  }
  [[nodiscard]] std::size_t factor_entries() const override {
    std::size_t sum = 0;
    for (const auto& stage : stages_) sum += stage->factor_entries();
    return sum;
  }

 private:
  std::vector<std::unique_ptr<DirectStage>> stages_;
};

}  // namespace

std::unique_ptr<StepSolver> make_direct_step_solver(const SemidiscreteProblem& problem,
                                                    const std::vector<OperatorCoefficients>& operators) {
  return std::make_unique<DirectStepSolver>(problem, operators);
}

}  // namespace ricochet
