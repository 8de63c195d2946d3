#include "ricochet/solver/contact/globalized_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/solver/contact/iteration_record.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

namespace ricochet {

namespace {

/// Newton steps covered by the rounding of q before the last of them is taken as exact.
constexpr int inexact_limit = 3;
/// Newton steps in a row before the sweeps take over again.
constexpr int newton_limit = 30;
/// Sweeps after a Newton step that has left more than this part of the merit (a square).
constexpr int smoothing_sweeps = 8;
constexpr double good_step = 1e-4;
/// Halvings of a Newton step.
constexpr int newton_step_cuts = 8;
/// Part of the step's length by which the merit has to decrease.
constexpr double sufficient_decrease = 1e-4;
/// Reduction of the residual of a linear system while the points still change their states.
constexpr double loose_reduction = 1e-3;

}  // namespace

double contact_merit(const ContactSystem& system, const ContactIterate& iterate) {
  double sum = 0.0;
  for (const ContactPoint& point : system.points()) {
    const double residual = alart_curnier_residual(point, 1.0 / point.diagonal, padded(point, iterate.reaction),
                                                   padded(point, iterate.motion));
    sum += residual * residual;
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

/// If rounding is required, sweeps end as soon as the rounding of q covers the residual. Newton's method leaves much
/// less, and a scheme that tests whether a gap is zero to rounding depends on the difference: klr-conserving would open
/// the point.
bool ContactWork::is_done(const ContactIterate& iterate) const {
  const ContactSystem::Measure measure = system.measure(iterate);
  if (options.tolerance > 0.0) return measure.beyond_floor <= options.tolerance * system.data();
  return measure.beyond_floor == 0.0 && measure.is_exact;
}

/// If the rounding of q is larger than that of sums, friction may be beyond its limit by as much.
bool ContactWork::is_solved_on_law(const ContactIterate& iterate, double tolerance, ContactIterate& on_law) const {
  on_law = iterate;
  IterativeContactSolver::put_on_law(system, iterate.motion, false, on_law.reaction);
  if (on_law.reaction != iterate.reaction) system.evaluate(on_law);
  return system.is_solved(on_law, tolerance);
}

bool ContactWork::is_loosely_solved(const ContactIterate& iterate, ContactIterate& on_law) const {
  return options.tolerance == 0.0 && is_solved_on_law(iterate, loosest_residual, on_law);
}

void BestIterate::restart(const ContactWork& work) {
  iterate = work.current;
  merit = work.merit();
}

double BestIterate::keep(const ContactWork& work) {
  const double current = work.merit();
  if (current < merit) {
    iterate = work.current;
    merit = current;
  }
  return current;
}

void GlobalizedNewton::start() {
  step_.start();
  sweeps_.restart();
}

void GlobalizedNewton::reset() {
  step_.reset();
  sparse_system_.reset();
}

/// Reduction of the residual of the next linear system: while states change the step need not be exact.
double GlobalizedNewton::next_reduction(const ContactWork& work) const {
  if (!step_.has_settled()) return loose_reduction;
  const double required = 0.1 * work.options.tolerance * work.system.data() / work.system.residual(work.current);
  return std::clamp(required, 1e-13, loose_reduction);
}

/// Computes the full Newton step, in `trial_`.
bool GlobalizedNewton::full_step(const ContactWork& work, double reduction) {
  if (work.system.dense() == nullptr) return sparse_step(work);
  if (!step_.step(work.system, work.current, trial_.reaction, reduction)) return false;
  if (step_.has_factored()) ++work.solution.factorizations;
  work.system.evaluate(trial_);
  if (step_.refine(trial_, trial_.reaction)) work.system.evaluate(trial_);
  return true;
}

bool GlobalizedNewton::sparse_step(const ContactWork& work) {
  equations_.clear();
  for (const ContactPoint& point : work.system.points()) {
    equations_.push_back(projection_equation(point, padded(point, work.current.reaction),
                                             padded(point, work.current.motion), DiscRadius::of_trial, true));
  }
  ++work.solution.factorizations;
  if (!sparse_system_.solve(work.system, equations_, trial_.reaction)) return false;
  trial_.reaction += work.current.reaction;
  work.system.evaluate(trial_);
  return true;
}

/// Searches from the current iterate towards the full step: the whole, half, quarter, … of it with a smaller merit
/// becomes the current one.
bool GlobalizedNewton::search_line(const ContactWork& work) {
  double length = 1.0;
  for (int k = 0; k <= newton_step_cuts; ++k, length *= 0.5) {
    if (k > 0) {
      cut_.reaction = work.current.reaction + length * (trial_.reaction - work.current.reaction);
      cut_.motion = work.current.motion + length * (trial_.motion - work.current.motion);
      cut_.size = work.current.size + length * (trial_.size - work.current.size);
    }
    ContactIterate& candidate = k == 0 ? trial_ : cut_;
    if (contact_merit(work.system, candidate) < (1.0 - sufficient_decrease * length) * current_merit_) {
      std::swap(work.current, candidate);
      return true;
    }
  }
  return false;
}

/// Full steps leave errors of short wavelength at points that changed their state, which sweeps remove: replaces the
/// step by the result of a few sweeps if that is better.
void GlobalizedNewton::smooth(const ContactWork& work) {
  cut_ = trial_;
  for (int k = 0; k < smoothing_sweeps; ++k) sweeps_.sweep(work.system, 1.0, cut_);
  if (contact_merit(work.system, cut_) < contact_merit(work.system, trial_)) std::swap(trial_, cut_);
}

bool GlobalizedNewton::run(const ContactWork& work, bool line_search, BestIterate& best) {
  const ContactSystem& system = work.system;
  current_merit_ = work.merit();
  double reduction = next_reduction(work);
  int inexact = 0;
  for (int k = 0; k < newton_limit; ++k) {
    ++work.solution.newton_steps;
    if (!full_step(work, reduction)) return false;
    reduction = next_reduction(work);
    note_iteration(system, work.options, "newton", system.residual(trial_), trial_.reaction, work.solution);
    if (system.is_solved(trial_, work.options.tolerance)) {
      std::swap(work.current, trial_);
      if (work.is_done(work.current)) return true;
      if (++inexact >= inexact_limit) {
        if (work.is_solved_on_law(work.current, work.options.tolerance, cut_)) return true;
        std::swap(work.current, cut_);  // there, points slip that stuck beyond their limit
      }
      current_merit_ = work.merit();
      continue;
    }
    if (line_search && contact_merit(system, trial_) > good_step * current_merit_) smooth(work);
    if (!line_search) {
      std::swap(work.current, trial_);
    } else if (!search_line(work)) {
      return false;
    }
    current_merit_ = best.keep(work);
  }
  return false;
}

}  // namespace ricochet
