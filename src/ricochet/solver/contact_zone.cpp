#include "ricochet/solver/contact_zone.hpp"

#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/stage_operator.hpp"

namespace ricochet {

namespace {

/// A on the zone, whole only until then.
SparseCholesky analysed_zone(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                             const std::vector<int>& dofs, const Vector& displacement) {
  const std::vector<int> number = number_dofs(problem, dofs);
  const auto count = static_cast<Index>(dofs.size());
  SparseCholesky factor;
  factor.analyse(extract(combine_operator(problem, coefficients, displacement), number, count, number, count));
  return factor;
}

}  // namespace

ContactZone::ContactZone(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                         const std::vector<char>& solved, const std::vector<Index>& nodes,
                         const std::vector<Index>& points, bool all_candidates, const Vector& displacement,
                         FactoredStage* layer)
    : has_(static_cast<std::size_t>(problem.contact.size()), 0) {
  for (const Index point : points) has_[static_cast<std::size_t>(point)] = 1;
  std::vector<int> dofs;
  for (const Index node : nodes) {
    for (Index dof = node * problem.dimension; dof < (node + 1) * problem.dimension; ++dof) {
      if (solved[static_cast<std::size_t>(dof)] != 0) dofs.push_back(static_cast<int>(dof));
    }
  }
  // A principal block of a positive definite matrix is one; where A is not, conjugate gradients say so too.
  zone_ = std::make_unique<FactoredStage>(
      problem, coefficients, dofs, analysed_zone(problem, coefficients, dofs, displacement), all_candidates, layer);
  correction_.setZero(problem.dof_count());
}

/// The stage on the correction: q and p at x instead of at δ = 0.
void ContactZone::state_locally(const Stage& stage, const Vector& x) {
  stage_ = stage;  // its right-hand side is not looked at; members that come later are not forgotten
  stage_.rows_in_store.clear();
  stage_.prescribed.setZero(stage.prescribed.size());
  stage.rows->normal_motion(x, motion_);
  stage_.gap_offset += stage.gap_factor * motion_;
  if (stage.slip_offset.size() > 0) {
    stage.rows->tangential_motion(x, slip_);
    stage_.slip_offset += stage.slip_factor * slip_;
  }
  for (std::size_t i = 0; i < has_.size(); ++i) {
    if (has_[i] == 0) stage_.eligible[i] = 0;
  }
}

void ContactZone::solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution) {
  state_locally(stage, x);
  zone_->solve(stage_, residual, solution, correction_);
  for (const int dof : zone_->dofs()) x[dof] += correction_[dof];
}

}  // namespace ricochet
