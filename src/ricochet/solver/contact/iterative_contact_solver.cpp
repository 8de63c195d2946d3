#include "ricochet/solver/contact/iterative_contact_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/dense_kernels.hpp"
#include "ricochet/solver/contact/iteration_record.hpp"

namespace ricochet {

namespace {
/// If a solver stops just inside the tolerance, putting r on its law may leave it just outside: repetitions with a
/// tighter one.
constexpr int tightenings = 4;
/// Points that do not penetrate at r = 0 by more than this part of the data are left out at first.
constexpr double margin = 0.1;

double accepted_residual(const ContactOptions& options) {
  return options.tolerance > 0.0 ? options.tolerance : loosest_residual;
}

void refuse_data(const std::string& reason, ContactSolution& solution,
                 double residual = std::numeric_limits<double>::quiet_NaN()) {
  solution.outcome = ContactOutcome::invalid_data;
  solution.reason = reason;
  solution.residual = residual;
}
}  // namespace

void IterativeContactSolver::analyse(const ContactProblem& problem) {
  problem.validate();
  system_.analyse(problem);
  analysed_ = problem.contact_operator;
  analysed_row_offset_ = problem.row_offset;
  twins_.forget();
  set_warm_start({});
}

void IterativeContactSolver::set_warm_start(const Vector& reactions) {
  forget();
  warm_reaction_.resize(0);
  const Index rows = analysed_ != nullptr ? analysed_->rows() : 0;
  if (reactions.size() > 0 && reactions.size() != rows) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("contact solver: the warm start has {} numbers, but there are {} reactions",
                            reactions.size(), rows));
  }
  if (!reactions.allFinite())
    throw Error(ErrorKind::invalid_input, "contact solver: the warm start has non-finite entries");
  warm_reaction_ = reactions;
}

void IterativeContactSolver::persist(const SnapshotVisitor& visit) {
  try {
    Vector reactions = warm_reaction_;
    visit("reactions", reactions);
    if (visit.loads()) set_warm_start(reactions);
    persist_memory(visit, analysed_row_offset_);
  } catch (const Error&) {
    if (visit.loads()) set_warm_start({});
    throw;
  }
}

void ContactOptions::validate() const {
  if (!(tolerance >= 0.0 && tolerance < 1.0))
    throw Error(ErrorKind::invalid_input,
                fmt::format("contact solver: the tolerance is {}; it must be at least 0 and below 1", tolerance));
  if (iteration_limit < 0) {
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("contact solver: the limit is {} iterations; it must be zero (the solver's own limit) or positive",
                    iteration_limit));
  }
}

/// Returns whether r = 0 is a solution.
bool IterativeContactSolver::is_open(const ContactProblem& problem) const {
  for (Index i = 0; i < problem.points(); ++i) {
    if (!problem.is_eligible(i)) continue;
    const Index row = problem.row_offset[std::size_t(i)];
    const double u = problem.offset[row];
    const double offset_rounding = problem.offset_rounding.size() > 0 ? problem.offset_rounding[row] : 0.0;
    if (!(u >= -(offset_rounding + sum_rounding * std::abs(u)))) return false;
  }
  return true;
}

void IterativeContactSolver::choose_points(const ContactProblem& problem) {
  const bool all = !works_on_candidates();
  selected_.assign(std::size_t(problem.points()), 0);
  for (Index i = 0; i < problem.points(); ++i) {
    const Index row = problem.row_offset[std::size_t(i)];
    const bool had_reaction = warm_reaction_.size() == problem.rows() && warm_reaction_[row] != 0.0;
    const bool may_press = all || system_.is_near(problem, i, margin) || had_reaction;
    selected_[std::size_t(i)] = (may_press && problem.is_eligible(i)) || keeps_row(row) ? 1 : 0;
  }
  system_.select(problem, selected_);
}

/// Restricts the last r to its admissible part.
void IterativeContactSolver::start(Vector& reaction) const {
  for (const ContactPoint& point : system_.points()) {
    auto r = reaction.segment(point.row, point.size);
    r[0] = std::max(r[0], 0.0);
    const double limit = point.friction_limit(r[0]);
    const double length = r.tail(point.size - 1).norm();
    if (length > limit) r.tail(point.size - 1) *= limit / length;
  }
}

void IterativeContactSolver::put_on_law(const ContactSystem& system, const Vector& motion, bool exactly,
                                        Vector& reaction) {
  for (const ContactPoint& point : system.points()) {
    auto r = reaction.segment(point.row, point.size);
    const bool grazing = point.is_tresca() && r[0] == 0.0;
    if (grazing) continue;
    if (!(r[0] > 0.0)) {
      r.setZero();
      continue;
    }
    if (point.size == 1) continue;
    auto friction = r.tail(point.size - 1);
    const double limit = point.friction_limit(r[0]);
    // The measure includes the direction, but weighted by a force that may be small.
    if (!exactly && std::abs(friction.norm() - limit) <= 4.0 * machine_epsilon * limit) continue;
    const PointVector u = motion.segment(point.row + 1, point.size - 1);
    const PointVector tau = friction - u / point.diagonal;
    const double length = tau.norm();
    if (length >= limit && length > 0.0) friction = tau * (limit / length);
    const double size = friction.norm();
    if (size > limit) friction *= limit / size;
  }
}

/// Computes u of the problem from its own W, unless the system has all of its rows.
void IterativeContactSolver::find_motion(const ContactProblem& problem, ContactSolution& solution) const {
  if (system_.rows() == problem.rows()) {
    system_.unscale_motion(finished_.motion, solution.motion);
    return;
  }
  const Matrix* w = problem.contact_operator->dense();
  if (w == nullptr) {
    problem.contact_operator->multiply(solution.reaction, solution.motion);
    solution.motion += problem.offset;
    return;
  }
  solution.motion = problem.offset;
  for (Index i = 0; i < problem.points(); ++i) {
    const Index row = problem.row_offset[std::size_t(i)];
    const Index size = problem.row_offset[std::size_t(i) + 1] - row;
    if (solution.reaction.segment(row, size).isZero(0.0)) continue;
    add_columns(problem.rows(), size, w->data() + row * w->rows(), w->rows(), solution.reaction.data() + row,
                solution.motion.data());
  }
}

/// Returns whether some point outside of the system penetrates, which is then added to it.
bool IterativeContactSolver::add_penetrating(const ContactProblem& problem, const ContactOptions& options,
                                             const ContactSolution& solution) {
  bool found = false;
  for (Index i = 0; i < problem.points(); ++i) {
    const auto at = std::size_t(i);
    if (selected_[at] != 0 || !problem.is_eligible(i)) continue;
    const Index row = problem.row_offset[at];
    if (!(solution.motion[row] < 0.0)) continue;
    const double offset_rounding = problem.offset_rounding.size() > 0 ? problem.offset_rounding[row] : 0.0;
    if (solution.motion[row] >= -(offset_rounding + sum_rounding * std::abs(problem.offset[row]))) continue;
    const bool steep = problem.friction_coefficient[i] > steep_coefficient;
    if (!steep &&
        system_.residual_of(problem, i, solution.reaction, solution.motion) <= options.tolerance * system_.data())
      continue;
    selected_[at] = 1;
    found = true;
  }
  return found;
}

/// Puts r on its law, evaluated and measured, in `finished_`. If rounding is required, turning friction against the
/// slip to the last digits may itself leave more than rounding: r then stays as it is.
void IterativeContactSolver::finish(const ContactOptions& options) {
  for (const bool exactly : {true, false}) {
    if (exactly && options.tolerance > 0.0) continue;
    finished_.reaction = current_.reaction;
    put_on_law(system_, current_.motion, exactly, finished_.reaction);
    if (finished_.reaction == current_.reaction) {
      finished_ = current_;
    } else {
      system_.evaluate(finished_);
    }
    measure_ = system_.measure(finished_);
    if (measure_.beyond_floor <= options.tolerance * system_.data()) return;
  }
}

void IterativeContactSolver::run(const ContactOptions& options, ContactSolution& solution) {
  ContactOptions closer = options;
  ContactSystem::Measure best;
  for (int k = 0; k <= tightenings; ++k, closer.tolerance *= 0.25) {
    system_.evaluate(current_);
    solution.reason = iterate(system_, closer, current_, solution);
    finish(options);
    current_.reaction = finished_.reaction;
    const bool improves = k == 0 || measure_.beyond_floor < best.beyond_floor;
    if (improves) {
      best = measure_;
      std::swap(closest_, finished_);
    }
    const bool enough = !improves && options.tolerance == 0.0 && best.beyond_floor <= loosest_residual * system_.data();
    if (!solution.reason.empty() || enough || best.beyond_floor <= options.tolerance * system_.data()) break;
  }
  std::swap(closest_, finished_);
  measure_ = best;
  system_.unscale_reaction(finished_.reaction, solution.reaction);
}

bool IterativeContactSolver::is_accepted(const ContactOptions& options) const {
  return measure_.beyond_floor <= accepted_residual(options) * system_.data();
}

void IterativeContactSolver::judge(const ContactProblem& problem, const ContactOptions& options,
                                   ContactSolution& solution) {
  double largest = measure_.residual;
  bool finite = solution.reaction.allFinite();
  for (Index i = 0; i < problem.points(); ++i) {
    if (!problem.is_eligible(i)) continue;
    const auto at = std::size_t(i);
    const Index row = problem.row_offset[at];
    finite = finite && solution.motion.segment(row, problem.row_offset[at + 1] - row).allFinite();
    if (selected_[at] != 0 || solution.motion[row] >= 0.0) continue;
    largest = std::max(largest, system_.residual_of(problem, i, solution.reaction, solution.motion));
  }
  solution.residual = largest / system_.data();
  solution.rounding_floor = measure_.rounding_floor / system_.data();
  if (!std::isfinite(largest) || !finite) {
    return refuse_data(
        "the iteration diverged: W has non-finite entries or is not positive semi-definite, or the reactions exceed "
        "the range of floating-point numbers",
        solution, solution.residual);
  }
  if (is_accepted(options)) {
    solution.outcome = ContactOutcome::solved;
    solution.reason.clear();
    warm_reaction_ = solution.reaction;
    return;
  }
  solution.outcome = ContactOutcome::not_converged;
  if (solution.reason.empty()) solution.reason = "the iteration limit was reached";
  if (largest <= accepted_residual(options) * system_.data()) {
    solution.reason =
        "the residual is meaningless, because the reactions have grown so large that rounding hides it: if a body is "
        "jammed by friction, there may be no solution";
  }
}

void IterativeContactSolver::find_status(const ContactProblem& problem, ContactSolution& solution) const {
  solution.status.assign(std::size_t(problem.points()), ContactStatus::open);
  for (const ContactPoint& point : system_.points()) {
    ContactStatus& status = solution.status[std::size_t(point.point)];
    const auto r = finished_.reaction.segment(point.row, point.size);
    if (r.isZero(0.0)) continue;
    status = ContactStatus::closed;
    if (!point.has_friction()) continue;
    status = ContactStatus::stick;
    const double limit = point.friction_limit(r[0]) * (1.0 - 8.0 * machine_epsilon);
    if (r.tail(point.size - 1).norm() < limit) continue;
    const double floor = system_.floor_of(point, finished_).tangential;
    if (finished_.motion.segment(point.row + 1, point.size - 1).norm() > floor) status = ContactStatus::slip;
  }
}

/// Solves on the selected points, from the solution's reactions, until no other penetrates. `exchanges`: of nearly
/// identical points only one is included, which others may replace.
void IterativeContactSolver::solve_on_selected(const ContactProblem& problem, const ContactOptions& options,
                                               bool exchanges, ContactSolution& solution) {
  while (true) {
    system_.scale_reaction(solution.reaction, current_.reaction);
    if (!current_.reaction.allFinite()) current_.reaction.setZero();  // scaled beyond the range of numbers
    start(current_.reaction);
    if (options.record) count_states(system_, current_.reaction, solution);
    run(options, solution);
    find_motion(problem, solution);
    if (!works_on_candidates()) return;
    const bool exchanged = exchanges && twins_.exchange(problem, solution.motion, selected_, solution.reaction);
    if (!exchanged && !add_penetrating(problem, options, solution)) return;
    system_.select(problem, selected_);
  }
}

/// Solves with one at a time of nearly identical points, from the best r so far. If that does not lead to a solution,
/// with all of them again.
void IterativeContactSolver::solve_without_twins(const ContactProblem& problem, const ContactOptions& options,
                                                 ContactSolution& solution) {
  has_all_points_ = false;
  const std::vector<char> all = selected_;
  const Vector best = solution.reaction;
  if (solution.motion.allFinite()) {
    twins_.choose(problem, solution.motion, selected_, solution.reaction);
    system_.select(problem, selected_);
    solve_on_selected(problem, options, true, solution);
    if (is_accepted(options)) return;
  }
  selected_ = all;
  solution.reaction = best;
  system_.select(problem, selected_);
  solve_on_selected(problem, options, false, solution);
}

void IterativeContactSolver::solve(const ContactProblem& problem, const ContactOptions& options,
                                   ContactSolution& solution) {
  if (problem.contact_operator != analysed_)
    throw Error(ErrorKind::invalid_input, "contact problem: W is not the operator that was analysed");
  if (problem.row_offset != analysed_row_offset_)
    throw Error(ErrorKind::invalid_input, "contact problem: the points are not those that were analysed");
  problem.validate();
  options.validate();
  solution.outcome = ContactOutcome::not_converged;
  solution.reason.clear();
  solution.contradiction.clear();
  solution.iterations = solution.newton_steps = solution.factorizations = 0;
  solution.residual = solution.rounding_floor = 0.0;
  solution.record.clear();
  if (options.record) solution.record_status.assign(std::size_t(problem.points()), ContactStatus::open);
  solution.reaction.setZero(problem.rows());
  solution.status.assign(std::size_t(problem.points()), ContactStatus::open);
  solution.motion = problem.offset;
  if (!system_.fault().empty()) return refuse_data(system_.fault(), solution);
  system_.set_data(problem);
  if (!system_.data_are_finite()) return refuse_data("the data of the contact problem are not finite", solution);
  if (is_open(problem)) {
    solution.outcome = ContactOutcome::solved;
    warm_reaction_ = solution.reaction;
    return;
  }
  if (!(system_.data() > 0.0))
    return refuse_data("the entries of q differ so much in magnitude that the smaller ones vanish beside the others",
                       solution);
  choose_points(problem);
  if (!system_.fault().empty()) return refuse_data(system_.fault(), solution);
  solution.reason = refuses(system_);
  if (!solution.reason.empty()) {
    solution.outcome = ContactOutcome::not_applicable;
    solution.residual = 1.0;
    return;
  }
  if (warm_reaction_.size() == problem.rows() && warm_reaction_.allFinite()) solution.reaction = warm_reaction_;
  has_all_points_ = works_on_candidates();
  solve_on_selected(problem, options, false, solution);
  if (has_all_points_ && !is_accepted(options) && solution.contradiction.empty() &&
      twins_.any(*analysed_, analysed_row_offset_))
    solve_without_twins(problem, options, solution);
  judge(problem, options, solution);
  find_status(problem, solution);
}

}  // namespace ricochet
