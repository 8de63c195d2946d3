#include "ricochet/solver/contact_zone.hpp"

#include <algorithm>

#include "ricochet/solver/stage_operator.hpp"

namespace ricochet {

ContactZone::ContactZone(const SemidiscreteProblem& problem, const SparseMatrix& matrix,
                         const std::vector<char>& solved, const std::vector<Index>& points, int layers,
                         bool all_candidates)
    : problem_(problem), has_(static_cast<std::size_t>(problem.contact.size()), 0) {
  for (const Index point : points) has_[static_cast<std::size_t>(point)] = 1;
  std::vector<int> dofs;
  choose_dofs(matrix, solved, points, layers, dofs);
  std::vector<int> number = number_dofs(problem, dofs);
  const auto count = static_cast<Index>(dofs.size());
  SparseMatrix block = extract(matrix, number, count, number, count);
  factor_.analyse(block);
  factor_.factorize(std::move(block));
  // A principal block of a positive definite matrix is one; where A is not, conjugate gradients say so too.
  if (!factor_.positive_definite())
    refuse_operator(problem, {}, dofs[static_cast<std::size_t>(factor_.failed_unknown())]);
  for (const int unknown : factor_.permutation()) dof_at_.push_back(dofs[static_cast<std::size_t>(unknown)]);
  factor_vector_.setZero(factor_.work_size());
  correction_.setZero(problem.dof_count());
  contact_ = std::make_unique<CondensedContact>(problem, std::move(number), factor_, all_candidates);
}

void ContactZone::choose_dofs(const SparseMatrix& matrix, const std::vector<char>& solved,
                              const std::vector<Index>& points, int layers, std::vector<int>& dofs) const {
  const int d = problem_.dimension;
  std::vector<char> inside(static_cast<std::size_t>(problem_.nodes.cols()), 0);
  std::vector<Index> nodes;
  const auto enter = [&](Index node) {
    if (inside[static_cast<std::size_t>(node)] != 0) return;
    inside[static_cast<std::size_t>(node)] = 1;
    nodes.push_back(node);
  };
  for (const Index point : points) {
    for (SparseRowMatrix::InnerIterator entry(problem_.contact.trace, point); entry; ++entry) enter(entry.col());
  }
  std::size_t begin = 0;
  for (int layer = 0; layer < layers; ++layer) {
    const std::size_t end = nodes.size();
    for (; begin < end; ++begin) {
      for (int k = 0; k < d; ++k) {
        for (SparseMatrix::InnerIterator entry(matrix, nodes[begin] * d + k); entry; ++entry) enter(entry.row() / d);
      }
    }
  }
  std::sort(nodes.begin(), nodes.end());
  for (const Index node : nodes) {
    for (int k = 0; k < d; ++k) {
      const Index dof = node * d + k;
      if (solved[static_cast<std::size_t>(dof)] != 0) dofs.push_back(static_cast<int>(dof));
    }
  }
}

/// The stage on the correction: q and p at x instead of at δ = 0.
void ContactZone::state_locally(const Stage& stage, const Vector& x) {
  stage_ = stage;
  stage_.right_hand_side.resize(0);
  stage_.prescribed.setZero(stage.prescribed.size());
  at_start_.noalias() = problem_.contact.gap_operator * x;
  stage_.gap_offset += stage.gap_factor * at_start_;
  if (stage.slip_offset.size() > 0) {
    at_start_.noalias() = problem_.contact.tangential_trace * x;
    stage_.slip_offset += stage.slip_factor * at_start_;
  }
  for (std::size_t i = 0; i < has_.size(); ++i) {
    if (has_[i] == 0) stage_.eligible[i] = 0;
  }
}

void ContactZone::solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution) {
  state_locally(stage, x);
  do {
    const double scale = factor_.scale();
    for (std::size_t i = 0; i < dof_at_.size(); ++i)
      factor_vector_[static_cast<Index>(i)] = scale * residual[dof_at_[i]];
    factor_.solve_lower(factor_vector_);
    contact_->solve(stage_, factor_vector_, solution);
    factor_.solve_upper(factor_vector_);
    for (std::size_t i = 0; i < dof_at_.size(); ++i) correction_[dof_at_[i]] = factor_vector_[static_cast<Index>(i)];
  } while (contact_->take_up_penetrating(stage_, correction_));
  for (const int dof : dof_at_) x[dof] += correction_[dof];
}

}  // namespace ricochet
