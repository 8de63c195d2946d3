#include "ricochet/solver/gathered/gathered_stage.hpp"

#include <algorithm>

#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/delassus/direct_stage.hpp"
#include "ricochet/solver/delassus/factored_stage.hpp"
#include "ricochet/solver/gathered/gathered_contact.hpp"
#include "ricochet/solver/gathered/gathered_matrix.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"
#include "ricochet/solver/stage/stage_terms.hpp"

namespace ricochet {

namespace {

/// Stage on the dofs of contact nodes, solved entirely at the root. Supports are on the right-hand side, and in the
/// gaps.
class GatheredStage final : public StageSolver {
 public:
  GatheredStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, SharedContact& shared,
                GatheredContact& contact);

  void solve(const LinearStage& stage, StageSolution& solution) override;
  void refactorize(const Vector&) override {
    throw Error(ErrorKind::invalid_input, "bodies at finite strain cannot be divided among processes");
  }
  void show_contact() const override {
    if (stage_) stage_->show_contact();
  }
  void persist(const SnapshotVisitor& visit) override {
    const auto at_root = [&] {
      if (stage_) stage_->persist(visit);
    };
    if (!visit.loads()) return at_root();
    problem_.ranks->run_collectively(at_root);
  }
  [[nodiscard]] FactoredStage* factored() override { return stage_ ? stage_->factored() : nullptr; }

 private:
  const SemidiscreteProblem& problem_;
  GatheredContact& contact_;
  SparseRowMatrix supported_;  ///< this rank's part of A's rows of supported dofs: supports × dofs
  std::vector<Index> points_;  ///< that take part in the stage
  Vector right_hand_side_, prescribed_, contact_force_;
  // At the root:
  std::unique_ptr<SemidiscreteProblem> root_problem_;
  std::unique_ptr<StageSolver> stage_;
  Stage root_stage_;
  StageSolution root_solution_;
};

/// Extracts A's rows of supported dofs without assembling the whole of A.
SparseRowMatrix supported_part(const SemidiscreteProblem& problem, const StageTerms& terms) {
  const int d = problem.dimension;
  std::vector<Index> nodes;
  for (const Index dof : problem.supports.dofs()) nodes.push_back(dof / d);
  if (nodes.empty()) return {0, problem.dof_count()};
  for (const NodeMatrix::Term& term : terms.all()) {
    const std::vector<Index> more = nodes_within(MatrixGraph(term.matrix->pattern()), nodes, 1).nodes;
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const std::vector<int> supports =
      number_dofs(problem, {problem.supports.dofs().begin(), problem.supports.dofs().end()});
  std::vector<int> row, column;
  for (const Index node : nodes) {
    for (Index dof = node * d; dof < (node + 1) * d; ++dof) {
      row.push_back(supports[std::size_t(dof)]);
      column.push_back(int(dof));
    }
  }
  return extract(terms.principal(nodes), row, problem.supports.size(), column, problem.dof_count());
}

GatheredStage::GatheredStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                             SharedContact& shared, GatheredContact& contact)
    : problem_(problem), contact_(contact) {
  const int d = problem.dimension;
  const std::vector<Index>& nodes = contact.nodes().nodes();
  const StageTerms terms(problem, coefficients, Vector());
  supported_ = supported_part(problem, terms);
  const SparseMatrix on_contact = terms.principal(nodes);
  const SparseMatrix gathered = gather_matrix(*problem.ranks, on_contact, nodes, d, contact.nodes());
  root_problem_ = contact.make_problem(contact.nodes());
  problem.ranks->run_collectively([&] {
    if (!contact.is_root()) return;
    AnalysedOperator analysed;
    analysed.dofs = solved_dofs(*root_problem_, StageDofs::contact);
    analysed.supported.resize(0, root_problem_->dof_count());
    const std::vector<int> number = number_dofs(*root_problem_, analysed.dofs);
    const auto count = Index(analysed.dofs.size());
    analysed.factor.analyse(extract(gathered, number, count, number, count));
    stage_ = make_direct_stage(*root_problem_, coefficients, std::move(analysed), shared);
  });
}

void GatheredStage::solve(const LinearStage& stage, StageSolution& solution) {
  const Ranks& ranks = *problem_.ranks;
  const int d = problem_.dimension;
  prescribed_.setZero(problem_.dof_count());
  prescribe(problem_, stage, prescribed_);
  right_hand_side_ = stage.right_hand_side.force;
  if (problem_.supports.size() > 0)
    right_hand_side_.noalias() -= supported_.transpose() * stage.right_hand_side.prescribed;
  ranks.accumulate(right_hand_side_);
  points_.clear();
  for (Index point = 0; point < problem_.contact.size(); ++point) {
    if (stage.conditions.eligible[std::size_t(point)] != 0) points_.push_back(point);
  }
  contact_.gather(stage, prescribed_, points_, root_stage_);
  root_stage_.right_hand_side.force = contact_.nodes().gather(right_hand_side_, d);
  ranks.run_collectively([&] {
    if (stage_) stage_->solve(root_stage_.linear(), root_solution_);
  });
  solution.open_all(problem_.contact.size(), problem_.contact.has_friction() ? d - 1 : 0);
  solution.increment = prescribed_;
  contact_.nodes().scatter(root_solution_.increment, d, solution.increment);
  // Supported dofs of contact nodes are not solved for.
  prescribe(problem_, stage, solution.increment);
  contact_.scatter(root_solution_, points_, solution);
  find_support_reaction(problem_, stage, supported_, contact_force_, solution);
}

}  // namespace

std::unique_ptr<StageSolver> make_gathered_stage(const SemidiscreteProblem& problem,
                                                 const OperatorCoefficients& coefficients, SharedContact& shared,
                                                 GatheredContact& contact) {
  return std::make_unique<GatheredStage>(problem, coefficients, shared, contact);
}

}  // namespace ricochet
