#include "ricochet/solver/subdomain/subdomain.hpp"

#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"

namespace ricochet {

namespace {

std::vector<int> solved_dofs_of(const std::vector<Index>& nodes, const std::vector<char>& solved, int d) {
  std::vector<int> dofs;
  for (const Index node : nodes) {
    for (Index dof = node * d; dof < (node + 1) * d; ++dof) {
      if (solved[static_cast<std::size_t>(dof)] != 0) dofs.push_back(static_cast<int>(dof));
    }
  }
  return dofs;
}

/// Analyses A on the dofs of the subdomain that are solved for.
SparseCholesky analyse_subdomain(const std::vector<Index>& nodes, const std::vector<char>& solved, int d,
                                 const StageProduct& product) {
  std::vector<int> number(nodes.size() * static_cast<std::size_t>(d), -1);
  int count = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    const Index dof = nodes[i / static_cast<std::size_t>(d)] * d + static_cast<Index>(i) % d;
    if (solved[static_cast<std::size_t>(dof)] != 0) number[i] = count++;
  }
  SparseCholesky factor;
  factor.analyse(extract(product.principal(nodes), number, count, number, count));
  return factor;
}

}  // namespace

Subdomain::Subdomain(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                     const std::vector<char>& solved, const Extent& extent, const StageProduct& product,
                     bool all_candidates, FactoredStage* condensed_stage)
    : has_(static_cast<std::size_t>(problem.contact.size()), 0), own_points_(extent.own_points) {
  for (const Index point : extent.points) has_[static_cast<std::size_t>(point)] = 1;
  own_dofs_ = solved_dofs_of(extent.own_nodes, solved, problem.dimension);
  // A principal block of a positive definite matrix is positive definite; if A is not, conjugate gradients report it,
  // too.
  stage_ = std::make_unique<FactoredStage>(
      problem, coefficients, solved_dofs_of(extent.nodes, solved, problem.dimension),
      analyse_subdomain(extent.nodes, solved, problem.dimension, product), all_candidates, condensed_stage);
}

void Subdomain::choose_points(const std::vector<char>& eligible, std::vector<char>& own) const {
  for (std::size_t i = 0; i < has_.size(); ++i) own[i] = has_[i] != 0 ? eligible[i] : char{0};
}

void Subdomain::solve(const LinearStage& stage, const Vector& residual, Vector& correction, Vector& x,
                      StageSolution& solution) {
  stage_->solve(stage, residual, solution, correction);
  for (const int dof : own_dofs_) x[dof] += correction[dof];
  for (const int dof : stage_->dofs()) correction[dof] = 0.0;
}

void Subdomain::restrict_to_own(const StageSolution& local, StageSolution& solution) const {
  const Index tangents = solution.tangential_reaction.size() / std::max<Index>(1, solution.normal_reaction.size());
  for (const Index point : own_points_) {
    solution.normal_reaction[point] = local.normal_reaction[point];
    solution.tangential_reaction.segment(point * tangents, tangents) =
        local.tangential_reaction.segment(point * tangents, tangents);
    solution.contact_status[static_cast<std::size_t>(point)] = local.contact_status[static_cast<std::size_t>(point)];
  }
}

}  // namespace ricochet
