#include "ricochet/solver/contact/globalized_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/solver/contact/iteration_record.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

namespace ricochet {

/// After this many steps whose residual only the rounding of q excuses, the iterate is projected on its law, and
/// accepted if that is solved.
constexpr int inexact_limit = 3;
/// Limit on the steps of one run().
constexpr int newton_limit = 30;
/// A step that leaves more than this part of the merit (a square) is followed by so many sweeps.
constexpr double good_step = 1e-4;
constexpr int smoothing_sweeps = 8;
/// Halvings of a Newton step.
constexpr int newton_step_cuts = 8;
/// A step of length t has to reduce the merit by more than this part of t (Armijo).
constexpr double sufficient_decrease = 1e-4;
/// Reduction of the residual of a linear system while the points still change their states.
constexpr double loose_reduction = 1e-3;

double contact_merit(const ContactSystem& system, const ContactIterate& iterate) {
  double sum = 0.0;
  for (const ContactPoint& point : system.points()) {
    const double residual = alart_curnier_residual(point, 1.0 / point.diagonal, padded(point, iterate.reaction),
                                                   padded(point, iterate.motion));
    sum += residual * residual;
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

bool ContactIteration::is_done(const ContactIterate& iterate) const {
  const ContactSystem::Measure measure = system.measure(iterate);
  if (options.tolerance > 0.0) return measure.beyond_floor <= options.tolerance * system.data();
  return measure.beyond_floor == 0.0 && measure.is_exact;
}

bool ContactIteration::is_solved_on_law(const ContactIterate& iterate, double tolerance, ContactIterate& on_law) const {
  on_law = iterate;
  IterativeContactSolver::put_on_law(system, iterate.motion, false, on_law.reaction);
  if (on_law.reaction != iterate.reaction) system.evaluate(on_law);
  return system.is_solved(on_law, tolerance);
}

bool ContactIteration::is_loosely_solved(const ContactIterate& iterate, ContactIterate& on_law) const {
  return options.tolerance == 0.0 && is_solved_on_law(iterate, loosest_residual, on_law);
}

void BestIterate::restart(const ContactIteration& iteration) {
  iterate = iteration.current;
  merit = iteration.merit();
}

double BestIterate::keep(const ContactIteration& iteration) {
  const double current = iteration.merit();
  if (current < merit) {
    iterate = iteration.current;
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
double GlobalizedNewton::next_reduction(const ContactIteration& iteration) const {
  if (!step_.has_settled()) return loose_reduction;
  const double required =
      0.1 * iteration.options.tolerance * iteration.system.data() / iteration.system.residual(iteration.current);
  return std::clamp(required, 1e-13, loose_reduction);
}

/// Computes the iterate of the full Newton step in `trial_`.
bool GlobalizedNewton::full_step(const ContactIteration& iteration, double reduction) {
  if (iteration.system.dense() == nullptr) return sparse_step(iteration);
  if (!step_.step(iteration.system, iteration.current, trial_.reaction, reduction)) return false;
  if (step_.has_factored()) ++iteration.solution.factorizations;
  iteration.system.evaluate(trial_);
  if (step_.refine(trial_, trial_.reaction)) iteration.system.evaluate(trial_);
  return true;
}

bool GlobalizedNewton::sparse_step(const ContactIteration& iteration) {
  equations_.clear();
  for (const ContactPoint& point : iteration.system.points()) {
    equations_.push_back(projection_equation(point, padded(point, iteration.current.reaction),
                                             padded(point, iteration.current.motion), DiscRadius::of_trial, true));
  }
  ++iteration.solution.factorizations;
  if (!sparse_system_.solve(iteration.system, equations_, trial_.reaction)) return false;
  trial_.reaction += iteration.current.reaction;
  iteration.system.evaluate(trial_);
  return true;
}

/// Searches from the current iterate towards the full step: the whole, half, quarter, … of it with a smaller merit
/// becomes the current one.
bool GlobalizedNewton::search_line(const ContactIteration& iteration) {
  double length = 1.0;
  for (int k = 0; k <= newton_step_cuts; ++k, length *= 0.5) {
    if (k > 0) {
      changed_.reaction = iteration.current.reaction + length * (trial_.reaction - iteration.current.reaction);
      changed_.motion = iteration.current.motion + length * (trial_.motion - iteration.current.motion);
      changed_.size = iteration.current.size + length * (trial_.size - iteration.current.size);
    }
    ContactIterate& candidate = k == 0 ? trial_ : changed_;
    if (contact_merit(iteration.system, candidate) < (1.0 - sufficient_decrease * length) * current_merit_) {
      std::swap(iteration.current, candidate);
      return true;
    }
  }
  return false;
}

/// Full steps leave errors of short wavelength at points that changed their state, which sweeps remove: replaces the
/// step by the result of a few sweeps if that is better.
void GlobalizedNewton::smooth(const ContactIteration& iteration) {
  changed_ = trial_;
  for (int k = 0; k < smoothing_sweeps; ++k) sweeps_.sweep(iteration.system, 1.0, changed_);
  if (contact_merit(iteration.system, changed_) < contact_merit(iteration.system, trial_)) std::swap(trial_, changed_);
}

bool GlobalizedNewton::run(const ContactIteration& iteration, bool line_search, BestIterate& best) {
  const ContactSystem& system = iteration.system;
  current_merit_ = iteration.merit();
  double reduction = next_reduction(iteration);
  int inexact = 0;
  for (int k = 0; k < newton_limit; ++k) {
    ++iteration.solution.newton_steps;
    if (!full_step(iteration, reduction)) return false;
    reduction = next_reduction(iteration);
    note_iteration(system, iteration.options, "newton", system.residual(trial_), trial_.reaction, iteration.solution);
    if (system.is_solved(trial_, iteration.options.tolerance)) {
      std::swap(iteration.current, trial_);
      if (iteration.is_done(iteration.current)) return true;
      if (++inexact >= inexact_limit) {
        if (iteration.is_solved_on_law(iteration.current, iteration.options.tolerance, changed_)) return true;
        std::swap(iteration.current, changed_);  // there, points slip that stuck beyond their limit
      }
      current_merit_ = iteration.merit();
      continue;
    }
    if (line_search && contact_merit(system, trial_) > good_step * current_merit_) smooth(iteration);
    if (!line_search) {
      std::swap(iteration.current, trial_);
    } else if (!search_line(iteration)) {
      return false;
    }
    current_merit_ = best.keep(iteration);
  }
  return false;
}

}  // namespace ricochet
