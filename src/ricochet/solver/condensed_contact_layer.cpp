#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/solver/condensed_contact.hpp"

// The contact operator, from YᵀY and a layer where there is one, and the means of reactions that a layer allows.

namespace ricochet {

/// YᵀY of the candidates so far.
Matrix CondensedContact::take_condensed() {
  if (layer_) return std::move(condensed_);
  return contact_.contact_operator != nullptr ? *contact_.contact_operator->dense() : Matrix();
}

/// The operator of the contact problem, from YᵀY of all candidates.
void CondensedContact::give_condensed(Matrix w) {
  if (!layer_) {
    hold_directions_without_trace(w);
    contact_.contact_operator = make_dense_operator(std::move(w));
    return;
  }
  const Matrix layer = layer_->compliance() / scale_;
  mean_.prepare((1.0 - 0.5 * layer_->weight()) * layer, w - layer, contact_.row_offset, layer_->mean());
  condensed_ = std::move(w);
  use_end_weight(mean_.theta());
}

/// U + θ Z.
void CondensedContact::use_end_weight(double theta) {
  Matrix w = mean_.combined(theta);
  hold_directions_without_trace(w);
  contact_.contact_operator = make_dense_operator(std::move(w));
}

void CondensedContact::take_starting_points(const Stage& stage) {
  std::vector<Index> pressing = pressing_at_start(layer_.get(), stage);
  must_ask_ = must_ask_ || !pressing.empty();
  std::erase_if(pressing, [&](Index point) { return candidates_.number(point) >= 0; });
  if (!pressing.empty()) take_up(pressing);
}

void CondensedContact::solve_mean(const Stage& stage) {
  const Index tangents = problem_.dimension - 1;
  Vector start_gap(contact_.points()), start = Vector::Zero(contact_.rows());
  for (Index i = 0; i < contact_.points(); ++i) {
    const Index point = candidates_.points()[static_cast<std::size_t>(i)];
    const Index row = contact_.row_offset[static_cast<std::size_t>(i)];
    start_gap[i] = stage.start_gap[point] / stage.gap_factor;
    start[row] = scale_ * stage.start_normal_reaction[point];
    for (Index k = 1; row + k < contact_.row_offset[static_cast<std::size_t>(i) + 1]; ++k)
      start[row + k] = -scale_ * stage.start_tangential_reaction[point * tangents + k - 1];
  }
  const Vector offset = contact_.offset;
  const auto solve = [&] { return try_contact(); };
  // The problem that is left, and exported, is the last that was solved.
  if (mean_.solve(contact_, offset, start_gap, start, solve, contact_solution_)) return;
  contact_.offset = offset;
  if (layer_->mean() == ReactionMean::path) throw_no_mean();
  if (!mean_.is_usable()) {  // the operator is that of the end reactions
    solve_contact();
    mean_.take_end(contact_solution_.reaction);
    return;
  }
  // The end reaction alone is always right.
  log::debug(
      fmt::format("contact: the mean of the reactions was not found ({}), the end reactions act", mean_.reason()));
  const Vector last = solver_->warm_start();  // of the last problem that was solved
  use_end_weight(1.0);
  solver_->analyse(contact_);
  solver_->set_warm_start(last);
  solve_contact();
  mean_.take_end(contact_solution_.reaction);
  use_end_weight(mean_.theta());
  solver_->analyse(contact_);
  solver_->set_warm_start(contact_solution_.reaction);
}

void CondensedContact::give_mean(const Stage& stage, StageSolution& solution) const {
  const Index tangents = problem_.dimension - 1;
  solution.mean_normal_reaction.setZero(solution.normal_reaction.size());
  solution.mean_tangential_reaction = solution.tangential_reaction;
  // Gaps and slips are gap_factor times the motions of the contact problem.
  solution.path_contact_work = -stage.gap_factor * mean_.path_work() / scale_;
  solution.path_friction_work = stage.gap_factor * mean_.friction_work() / scale_;
  solution.end_weight = mean_.end_weight();
  for (std::size_t i = 0; i < candidates_.points().size(); ++i) {
    const Index point = candidates_.points()[i], row = contact_.row_offset[i];
    solution.mean_normal_reaction[point] = mean_.mean()[row] / scale_;
    for (Index k = 1; row + k < contact_.row_offset[i + 1]; ++k)
      solution.mean_tangential_reaction[point * tangents + k - 1] = -mean_.mean()[row + k] / scale_;
  }
}

void CondensedContact::throw_no_mean() const {
  throw Error(ErrorKind::not_converged,
              fmt::format("the mean of the reactions over the step was not found ({} points): {}; such steps are far "
                          "longer than the time in which a wave crosses a cell: take shorter ones, or scheme "
                          "\"reduced-kane\"",
                          contact_.points(), mean_.reason()));
}

}  // namespace ricochet
