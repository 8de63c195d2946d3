#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/solver/delassus/delassus_problem.hpp"

// Contact operator from YᵀY and massless contact nodes, if any, and the means of reactions that these permit.

namespace ricochet {

void DelassusProblem::invalidate_columns() { has_new_factor_ = true; }

/// Rescales by powers of two: nothing is rounded.
void DelassusProblem::set_scale(double scale) {
  const double ratio = scale / scale_;
  scale_ = contact_.reaction_scale = scale;
  if (ratio == 1.0 || solver_ == nullptr) return;
  bound_ *= ratio;
  contact_.friction_bound = bound_;
  contact_solution_.reaction *= ratio;
  scale_warm_start(ratio);
}

void DelassusProblem::scale_warm_start(double ratio) {
  if (ratio != 1.0 && solver_->warm_start().size() > 0) solver_->set_warm_start(Vector(ratio * solver_->warm_start()));
}

/// Sets the operator for other rows of the same candidates; the contact solver keeps its memory.
void DelassusProblem::use_condensed(Matrix w) {
  append_supported();
  set_contact_operator(std::move(w));
  Snapshot memory;
  solver_->persist(memory.saver("solver"));
  solver_->analyse(contact_);
  solver_->persist(memory.loader("solver"));
}

/// If B_T has no trace in a direction (a support holds the body there), any positive diagonal keeps W definite and
/// makes the friction along it zero.
void DelassusProblem::regularize_directions_without_trace(Matrix& w) const {
  for (std::size_t i = 0; i + 1 < contact_.row_offset.size(); ++i) {
    const Index row = contact_.row_offset[i];
    for (Index k = row + 1; k < contact_.row_offset[i + 1]; ++k) {
      if (w(k, k) == 0.0) w(k, k) = w(row, row);
    }
  }
}

/// Sets the operator of the contact problem from YᵀY of all candidates.
void DelassusProblem::set_contact_operator(Matrix w) {
  const bool any_follows = basis_.any_follows();
  if (any_follows) {
    column_product_ = std::move(w);
    w = basis_.product(column_product_);
  }
  if (!massless_nodes_) {
    regularize_directions_without_trace(w);
    contact_.contact_operator = make_dense_operator(std::move(w));
    return;
  }
  Matrix massless_compliance = massless_nodes_->compliance() / scale_;
  if (any_follows) massless_compliance = basis_.product(massless_compliance);
  mean_.prepare((1.0 - 0.5 * massless_nodes_->weight()) * massless_compliance, w - massless_compliance,
                contact_.row_offset, massless_nodes_->acting());
  if (!any_follows) column_product_ = std::move(w);
  use_end_weight(mean_.theta());
}

/// Sets the operator U + θ Z.
void DelassusProblem::use_end_weight(double theta) {
  Matrix w = mean_.combined(theta);
  regularize_directions_without_trace(w);
  contact_.contact_operator = make_dense_operator(std::move(w));
}

void DelassusProblem::add_initial_candidates(const LinearStage& stage) {
  std::vector<Index> pressing;
  if (massless_nodes_) pressing = pressing_at_start(massless_nodes_->acting(), stage);
  candidates_required_ = candidates_required_ || !pressing.empty();
  std::erase_if(pressing, [&](Index point) { return candidates_.number(point) >= 0; });
  if (!pressing.empty()) add_candidates(pressing);
}

void DelassusProblem::solve_mean(const LinearStage& stage) {
  const Index tangents = problem_.dimension - 1;
  Vector start_gap(contact_.points()), start = Vector::Zero(contact_.rows());
  for (Index i = 0; i < contact_.points(); ++i) {
    const Index point = candidates_.points()[std::size_t(i)];
    const Index row = contact_.row_offset[std::size_t(i)];
    start_gap[i] = stage.start.gap[point] / stage.conditions.gap.factor;
    start[row] = scale_ * stage.start.normal_reaction[point];
    for (Index k = 1; row + k < contact_.row_offset[std::size_t(i) + 1]; ++k)
      start[row + k] = -scale_ * stage.start.tangential_reaction[point * tangents + k - 1];
  }
  const Vector offset = contact_.offset;
  const auto solve = [&] { return try_contact(); };
  // The problem that remains, and is exported, is the last one solved.
  if (mean_.solve(contact_, offset, start_gap, start, solve, contact_solution_)) return;
  contact_.offset = offset;
  if (massless_nodes_->acting() == ActingReaction::path_mean) throw_no_mean();
  if (!mean_.is_usable()) {  // the operator is that of the end reactions
    solve_contact();
    mean_.set_end_reaction(contact_solution_.reaction);
    return;
  }
  // The end reaction alone is always admissible.
  log::debug(fmt::format("contact: the mean of the reactions was not found ({}); the end reactions act instead",
                         mean_.reason()));
  const Vector last = solver_->warm_start();  // of the last problem solved
  use_end_weight(1.0);
  solver_->analyse(contact_);
  solver_->set_warm_start(last);
  solve_contact();
  mean_.set_end_reaction(contact_solution_.reaction);
  use_end_weight(mean_.theta());
  solver_->analyse(contact_);
  solver_->set_warm_start(contact_solution_.reaction);
}

void DelassusProblem::write_mean_reactions(const LinearStage& stage, StageSolution& solution) const {
  const Index tangents = problem_.dimension - 1;
  solution.mean_normal_reaction.setZero(solution.normal_reaction.size());
  solution.mean_tangential_reaction = solution.tangential_reaction;
  // Gaps and slips are gap_factor times the motions of the contact problem.
  solution.path_contact_work = -stage.conditions.gap.factor * mean_.path_work() / scale_;
  solution.path_friction_work = stage.conditions.gap.factor * mean_.friction_work() / scale_;
  solution.end_weight = mean_.end_weight();
  for (std::size_t i = 0; i < candidates_.points().size(); ++i) {
    const Index point = candidates_.points()[i], row = contact_.row_offset[i];
    solution.mean_normal_reaction[point] = mean_.mean()[row] / scale_;
    for (Index k = 1; row + k < contact_.row_offset[i + 1]; ++k)
      solution.mean_tangential_reaction[point * tangents + k - 1] = -mean_.mean()[row + k] / scale_;
  }
}

void DelassusProblem::throw_no_mean() const {
  throw Error(
      ErrorKind::not_converged,
      fmt::format("the mean of the reactions over the step was not found ({} points): {}; such steps are far longer "
                  "than the time in which a wave crosses a cell: use shorter steps, or scheme \"reduced-kane\"",
                  contact_.points(), mean_.reason()));
}

}  // namespace ricochet
