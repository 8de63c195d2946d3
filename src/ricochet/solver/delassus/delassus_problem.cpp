#include "ricochet/solver/delassus/delassus_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/timer.hpp"

namespace ricochet {

DelassusProblem::DelassusProblem(const SemidiscreteProblem& problem, std::vector<int> unknown,
                                 const SparseCholesky& factor, SharedContact& shared,
                                 std::unique_ptr<MasslessContactNodes> massless_nodes)
    : problem_(problem),
      factor_(factor),
      unknown_(std::move(unknown)),
      scale_(factor.scale()),
      friction_(problem.contact.has_friction()),
      shared_(shared),
      rows_(problem.contact.rows.get()),
      candidates_(problem.contact.size(), *problem.ranks),
      columns_(factor),
      massless_nodes_(std::move(massless_nodes)) {
  contact_.reaction_scale = scale_;
  std::vector<Index> points(shared.all_points ? std::size_t(problem.contact.size()) : 0);
  std::iota(points.begin(), points.end(), Index{0});
  start_again_with(points);
}

Index DelassusProblem::rows_of(Index point) const {
  return problem_.contact.has_friction(point) ? problem_.dimension : 1;
}

void DelassusProblem::start_again_with(const std::vector<Index>& points) {
  candidates_.clear();
  revision_.clear();
  candidate_counts_.clear();
  columns_.clear();
  basis_.clear();
  dof_batches_.clear();
  if (massless_nodes_) massless_nodes_->clear();
  column_product_.resize(0, 0);
  contact_.contact_operator.reset();
  contact_.row_offset.assign(1, 0);
  solver_.reset();
  if (!points.empty()) add_candidates(points);
}

/// Sorts points by their position in the elimination tree: points whose dofs are close there have nearly the same
/// columns.
void DelassusProblem::sort_by_tree_position(std::vector<Index>& points) const {
  std::vector<Index> position(points.size(), 0);
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    order[i] = i;
    visit_rows(points[i], [&](Index, Index dof, double) {
      const int unknown = unknown_[std::size_t(dof)];
      if (unknown >= 0) position[i] = std::max(position[i], factor_.factor_index(unknown));
    });
  }
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(position[a], points[a]) < std::pair(position[b], points[b]);
  });
  std::vector<Index> sorted;
  for (const std::size_t i : order) sorted.push_back(points[i]);
  points = std::move(sorted);
}

void DelassusProblem::add_candidates(std::vector<Index> points) {
  sort_by_tree_position(points);
  append_candidates(points);
}

void DelassusProblem::append_candidates(const std::vector<Index>& points) {
  Vector start = solver_ != nullptr ? contact_solution_.reaction : Vector();
  Matrix w = release_column_product();
  append_rows(points, w);
  append_dofs(missing_dofs(), w);
  prepare_contact(std::move(w), std::move(start));
}

/// Appends points with their rows. Of a point whose rows follow the motion, E has the dofs that append_dofs() gives it.
void DelassusProblem::append_rows(const std::vector<Index>& points, Matrix& w) {
  candidates_.add_candidates(points);
  candidate_counts_.push_back(Index(candidates_.points().size()));
  const Index first = basis_.size();
  for (const Index point : points) {
    contact_.row_offset.push_back(contact_.row_offset.back() + rows_of(point));
    basis_.append_candidate(rows_of(point), problem_.contact.follows_motion(point));
    revision_.push_back(rows_->revision.empty() ? -1 : rows_->revision[std::size_t(point)]);
  }
  append_columns(first, w);
}

/// Sets the contact problem of all candidates, with reactions of the former ones, and none on the others.
void DelassusProblem::prepare_contact(Matrix w, Vector start) {
  read_directions();
  append_supported();
  const auto count = Index(candidates_.points().size());
  coefficient_.resize(count);
  bound_.resize(count);
  for (Index i = 0; i < count; ++i) {
    const Index point = candidates_.points()[std::size_t(i)];
    coefficient_[i] = problem_.contact.friction_coefficient[point];
    bound_[i] = scale_ * problem_.contact.friction_bound[point];
  }
  contact_.point_numbers = candidates_.points();
  contact_.friction_coefficient = coefficient_;
  contact_.friction_bound = bound_;
  contact_.offset.setZero(contact_.row_offset.back());
  contact_.offset_rounding.setZero(contact_.row_offset.back());
  contact_.eligible.assign(std::size_t(count), 1);
  set_contact_operator(std::move(w));
  if (solver_ == nullptr) solver_ = make_contact_solver();
  solver_->analyse(contact_);
  const Index before = start.size();
  start.conservativeResize(contact_.row_offset.back());
  start.tail(start.size() - before).setZero();
  solver_->set_warm_start(start);
  contact_solution_.reaction = start;
}

void DelassusProblem::persist(const SnapshotVisitor& visit) {
  std::vector<Index> points = candidates_.points(), counts = candidate_counts_, batches = dof_batches_;
  std::vector<int> dofs = basis_.dofs();
  double scale = scale_;
  visit("candidates", points, {0, problem_.contact.size() - 1});
  visit("taken_up", counts, {1, Index(points.size())});
  visit("dofs", dofs, {0, problem_.dof_count() - 1});
  visit("dof_batches", batches, {0, std::max(Index(counts.size()), Index(dofs.size()))});
  visit("scale", scale);
  if (visit.loads()) {
    // Scale of the factor that the state has: a solver whose reactions are rescaled loses its history.
    scale_ = contact_.reaction_scale = factor_.scale();
    start_again_with({});
    if (!points.empty()) append_batches(points, counts, dofs, batches);
  }
  candidates_.persist_history(visit);
  if (solver_ == nullptr) return;
  solver_->persist(visit.part("solver"));
  if (!visit.loads()) return;
  visit.require(std::isnormal(scale) && scale > 0.0, "scale", "is not a positive number");
  scale_warm_start(scale_ / scale);
  contact_solution_.reaction = solver_->warm_start();
  if (contact_solution_.reaction.size() == 0) contact_solution_.reaction.setZero(contact_.row_offset.back());
}

/// Appends candidates and dofs in the batches of a run that is continued: the bits of W depend on them.
void DelassusProblem::append_batches(const std::vector<Index>& points, const std::vector<Index>& counts,
                                     const std::vector<int>& dofs, const std::vector<Index>& batches) {
  Matrix w;
  std::size_t batch = 0;
  Index begin = 0, first_dof = 0;
  for (const Index end : counts) {
    if (end <= begin) continue;
    append_rows({points.begin() + begin, points.begin() + end}, w);
    begin = end;
    for (; batch + 1 < batches.size() && batches[batch] <= Index(candidate_counts_.size()); batch += 2) {
      const Index last_dof = std::clamp(batches[batch + 1], first_dof, Index(dofs.size()));
      append_dofs({dofs.begin() + first_dof, dofs.begin() + last_dof}, w);
      first_dof = last_dof;
    }
  }
  std::ranges::fill(revision_, -1);  // rows are those of the next stage
  prepare_contact(std::move(w), {});
}

void DelassusProblem::find_offsets(const LinearStage& stage, const Vector& y) {
  columns_.motion(y, basis_.any_follows() ? of_columns_ : contact_.offset);
  if (basis_.any_follows()) basis_.to_rows(of_columns_, contact_.offset);
  if (supported_.nonZeros() > 0) contact_.offset.noalias() += supported_ * stage.right_hand_side.prescribed;
  const Index tangents = problem_.dimension - 1;
  for (std::size_t i = 0; i < candidates_.points().size(); ++i) {
    const Index point = candidates_.points()[i];
    const Index row = contact_.row_offset[i];
    const Index count = contact_.row_offset[i + 1] - row - 1;
    contact_.offset[row] += stage.conditions.gap.offset[point] / stage.conditions.gap.factor;
    contact_.offset_rounding[row] = stage.conditions.gap.rounding[point] / stage.conditions.gap.factor;
    if (count == 0) continue;
    if (stage.conditions.slip.offset.size() == 0) {
      contact_.offset_rounding.segment(row + 1, count).setZero();
      continue;
    }
    contact_.offset.segment(row + 1, count) +=
        stage.conditions.slip.offset.segment(point * tangents, tangents) / stage.conditions.slip.factor;
    contact_.offset_rounding.segment(row + 1, count)
        .setConstant(stage.conditions.slip.rounding[point] / stage.conditions.slip.factor);
  }
}

void DelassusProblem::solve(const LinearStage& stage, Vector& y, StageSolution& solution) {
  const Index points = problem_.contact.size();
  solution.normal_reaction.setZero(points);
  if (friction_) solution.tangential_reaction.setZero(points * (problem_.dimension - 1));
  solution.contact_status.assign(std::size_t(points), ContactStatus::open);
  candidates_active_ = false;
  iterations_ = 0;
  solution.clear_mean();
  set_rows(stage);
  if (std::ranges::none_of(stage.conditions.eligible, [](char e) { return e != 0; })) return;
  add_initial_candidates(stage);
  if (!shared_.all_points && !choose_candidates(stage)) return;
  add_initial_candidates(stage);  // candidates that were dropped
  find_offsets(stage, y);
  choose_friction(stage);
  const bool has_mean = massless_nodes_ && massless_nodes_->acting() != ActingReaction::end;
  if (has_mean) {
    solve_mean(stage);
  } else {
    solve_contact();
  }
  candidates_active_ = true;
  const Vector& acting = has_mean ? mean_.mean() : contact_solution_.reaction;
  if (basis_.any_follows()) basis_.to_basis(acting, of_columns_);
  columns_.add_reaction(basis_.any_follows() ? of_columns_ : acting, y);
  write_solution(stage, solution);
}

/// Returns false if nothing can touch.
bool DelassusProblem::choose_candidates(const LinearStage& stage) {
  candidates_.estimate_reach(stage.conditions);
  if (!candidates_required_ && !candidates_.some_may_touch(stage.conditions)) return false;
  if (const std::vector<Index> kept = candidates_.worth_keeping(stage.conditions); !kept.empty())
    start_again_with(kept);
  if (const std::vector<Index> near = candidates_.approaching(stage.conditions); !near.empty()) add_candidates(near);
  return !candidates_.points().empty();
}

void DelassusProblem::write_solution(const LinearStage& stage, StageSolution& solution) const {
  const Vector& reaction = contact_solution_.reaction;
  solution.iterations += iterations_;
  const Index tangents = problem_.dimension - 1;
  for (std::size_t i = 0; i < candidates_.points().size(); ++i) {
    const Index point = candidates_.points()[i];
    const Index row = contact_.row_offset[i];
    solution.contact_status[std::size_t(point)] = contact_solution_.status[i];
    solution.normal_reaction[point] = reaction[row] / scale_;
    for (Index k = 1; row + k < contact_.row_offset[i + 1]; ++k)
      solution.tangential_reaction[point * tangents + k - 1] = -reaction[row + k] / scale_;
  }
  if (massless_nodes_ && massless_nodes_->acting() != ActingReaction::end) write_mean_reactions(stage, solution);
}

bool DelassusProblem::add_penetrating(const LinearStage& stage, const Vector& increment, StageSolution& solution) {
  if (massless_nodes_) massless_nodes_->find_motion(stage.rows, solution, increment, solution.contact_increment);
  stage.rows.normal_motion(massless_nodes_ ? solution.contact_increment : increment, motion_);
  std::vector<Index> found = candidates_.penetrating(stage.conditions, motion_, !candidates_active_);
  candidates_required_ = !found.empty();
  if (!candidates_required_) {
    candidates_.update_history(stage.conditions, motion_, candidates_active_ ? closed_points() : 0);
    return false;
  }
  std::erase_if(found, [&](Index point) { return candidates_.number(point) >= 0; });
  if (!found.empty()) add_candidates(found);
  return true;
}

std::size_t DelassusProblem::closed_points() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < contact_.row_offset.size(); ++i)
    count += contact_solution_.reaction[contact_.row_offset[i]] > 0.0 ? 1 : 0;
  return count;
}

/// Sets friction in stages that have a slip rate, at points where these do not leave it out.
void DelassusProblem::choose_friction(const LinearStage& stage) {
  for (std::size_t i = 0; i < candidates_.points().size(); ++i)
    contact_.eligible[i] = stage.conditions.eligible[std::size_t(candidates_.points()[i])];
  if (!friction_) return;
  contact_.friction_coefficient = coefficient_;
  contact_.friction_bound = bound_;
  for (Index i = 0; i < coefficient_.size(); ++i) {
    const auto point = std::size_t(candidates_.points()[std::size_t(i)]);
    const bool left_out = !stage.conditions.frictionless.empty() && stage.conditions.frictionless[point] != 0;
    if (stage.conditions.slip.offset.size() > 0 && !left_out) continue;
    contact_.friction_coefficient[i] = 0.0;
    contact_.friction_bound[i] = 0.0;
  }
}

/// Returns false if the problem was not solved.
bool DelassusProblem::try_contact() {
  const Timer timer;
  solver_->solve(contact_, {.record = log::enabled(log::Level::debug)}, contact_solution_);
  shared_.solver_seconds += timer.seconds();
  iterations_ += contact_solution_.iterations;
  if (log::enabled(log::Level::debug)) log_iterations();
  return contact_solution_.solved();
}

void DelassusProblem::solve_contact() {
  if (try_contact()) return;
  if (shared_.observer) shared_.observer(contact_, contact_solution_);
  throw_not_solved();
}

/// Logs a line per iteration, which shows where a step spends its time or why it fails.
void DelassusProblem::log_iterations() const {
  if (contact_solution_.record.empty()) {
    log::debug(fmt::format("contact: {} points, no iterations needed", contact_.points()));
    return;
  }
  for (std::size_t k = 0; k < contact_solution_.record.size(); ++k) {
    const IterationRecord& line = contact_solution_.record[k];
    log::debug(fmt::format("contact: {} points, iteration {} ({}): residual {:.2e}, {} closed{}, {} changed",
                           contact_.points(), k + 1, line.phase, line.residual, line.closed,
                           friction_ ? fmt::format(" ({} stick, {} slip)", line.sticking, line.slipping) : "",
                           line.changed));
  }
}

void DelassusProblem::report() const {
  if (candidates_active_ && shared_.observer) shared_.observer(contact_, contact_solution_);
}

}  // namespace ricochet
