#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/solver/contact/active_set.hpp"
#include "ricochet/solver/contact/contact_costs.hpp"
#include "ricochet/solver/contact/gauss_seidel.hpp"
#include "ricochet/solver/contact/globalized_newton.hpp"
#include "ricochet/solver/contact/iteration_record.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"
#include "ricochet/solver/contact/other_solvers.hpp"

namespace ricochet {

namespace {

/// Largest number of accelerated sweeps.
constexpr int accelerated_limit = 500;
/// Reduction of the residual up to which an iteration in single precision is reliable.
constexpr double rough_digits = 1e-5;
/// Number of verdicts after which the rounding of W r is left to Newton's method.
constexpr int verdict_limit = 6;
/// Sweeps over which the progress of the accelerated ones is judged.
constexpr std::size_t outlook = 5;
/// If the fourth sweep leaves more than this part of the second one's residual, W is ill-conditioned, and Newton's
/// method takes over at once if it costs no more than so many sweeps.
constexpr double stall = 0.4;
constexpr double affordable_newton = 1000.0;
/// Plain sweeps between runs of Newton steps, the first time.
constexpr int cold_sweeps = 20;
/// Alternations of sweeps and Newton's method; the number of sweeps doubles every time.
constexpr int alternation_limit = 6;
/// Smallest part of a point's correction that is taken.
constexpr double smallest_damping = 0.125;
/// Residual, relative to the larger one of the data and the first, from which on sweeps diverge: W is not positive
/// semi-definite.
constexpr double divergence = 1e6;
/// Number of long runs of sweeps at the very end, and their length in entries of W.
constexpr int last_iterations = 20;
constexpr double last_work = 2e7;

bool has_friction(const ContactSystem& system) {
  return std::any_of(system.points().begin(), system.points().end(), [](const auto& p) { return p.has_friction(); });
}

bool is_nearly_closed(const ContactSystem& system, const ContactIterate& iterate) {
  const auto closed = std::count_if(system.points().begin(), system.points().end(),
                                    [&](const auto& p) { return iterate.reaction[p.row] > 0.0; });
  return 10 * closed >= 9 * std::ptrdiff_t(system.points().size());
}

/// Nonsmooth Newton method after accelerated projected Gauss–Seidel.
///
/// 0. Without friction and with the entries of W: the primal–dual active set, or the dual one if conditions depend on
/// one another. From the reactions of an earlier step, if the factor kept from it has proved cheaper than sweeps:
/// Newton's method at once.
/// 1. From the last r, accelerated sweeps: first order, robust; they determine the contact and the directions of slip
/// roughly, and if W is well-conditioned they continue to the end.
/// 2. Newton's method on the Alart–Curnier equations (GlobalizedNewton), each step cut back until the merit decreases;
/// if no part of a step does, a run of full steps from the best r so far.
/// 3. If that stalls, the same from r = 0; then another Newton method.
/// 4. More sweeps from the best r so far, then Newton's method again, twice as many sweeps every time; then from r = 0,
/// with sweeps that take a half, a quarter, an eighth of each point's correction.
/// 5. The other solvers. Finally full sweeps for as long as they bring progress.
///
/// If points are nearly identical (TwinPoints), 3 to 5 are tried only after the problem with one of them.
class AutomaticSolver final : public IterativeContactSolver {
 public:
  std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                      ContactSolution& solution) override;

 protected:
  [[nodiscard]] bool works_on_candidates() const override { return true; }
  void forget() override {
    newton_.reset();
    others_.forget();
    frictionless_.reset();
    costs_ = {};
  }
  void persist_memory(const SnapshotVisitor& visit, const std::vector<Index>& row_offset) override;
  [[nodiscard]] bool keeps_row(Index problem_row) const override {
    return frictionless_.keeps_row(problem_row) || newton_.step().reused().keeps_row(problem_row);
  }

 private:
  bool accelerated(const ContactIteration& iteration);
  bool sweep(const ContactIteration& iteration, int sweeps, double damping);
  std::string iterate_with_products(const ContactIteration& iteration);
  bool newton(const ContactIteration& iteration);
  bool sweeps_and_newton(const ContactIteration& iteration);
  bool alternate(const ContactIteration& iteration, int sweeps, double damping);
  std::string find_contradiction(const ContactIteration& iteration);
  bool fall_back(const ContactIteration& iteration, bool was_cold);
  static void begin_at_zero(const ContactIteration& iteration);
  void keep_fallback();
  bool sweep_on(const ContactIteration& iteration);

  GaussSeidel sweeps_;
  AcceleratedGaussSeidel accelerated_;
  GlobalizedNewton newton_;
  std::unique_ptr<IterativeContactSolver> products_;  ///< used without entries of W
  OtherSolvers others_;                               ///< fallback
  PrimalDualActiveSet frictionless_;
  DualActiveSet normals_;
  BestIterate best_;      ///< of a part of the iteration
  BestIterate fallback_;  ///< of the whole iteration
  ContactIterate on_law_;
  Vector begin_;
  bool stalled_ = false;
  bool diverges_ = false;  ///< whether the last plain sweeps diverged
  ContactCosts costs_;
};

void AutomaticSolver::persist_memory(const SnapshotVisitor& visit, const std::vector<Index>& row_offset) {
  visit.numbers("costs", costs_.of_sweeps, costs_.of_newton);
  visit.require(costs_.of_sweeps >= 0.0 && costs_.of_newton >= 0.0, "costs", "has negative entries");
  std::vector<Index> base = frictionless_.base();
  visit("active_set", base);
  if (visit.loads()) {
    visit.require(are_first_rows(row_offset, base, true), "active_set",
                  "has entries that are not points of this problem");
    frictionless_.set_base(base);
  }
  newton_.step().reused().persist(visit, row_offset);
}

/// Performs accelerated sweeps for as long as they promise to converge sooner than Newton's method.
bool AutomaticSolver::accelerated(const ContactIteration& iteration) {
  const ContactSystem& system = iteration.system;
  const double target = std::max(iteration.options.tolerance, 1e-14) * system.data();
  accelerated_.start(system);
  stalled_ = false;
  std::array<double, outlook> earlier{};
  double best = std::numeric_limits<double>::infinity();
  int unchanged = 0, verdicts = 0;
  double second = 0.0;
  double residual_per_change = 1.0;
  double exact_residual = system.has_rough_entries() ? system.data() : 0.0;  // when u was last evaluated
  for (int k = 0; k < accelerated_limit; ++k) {
    unchanged = accelerated_.sweep(system, iteration.current) ? 0 : unchanged + 1;
    const double change = accelerated_.change();
    if (!std::isfinite(change)) break;
    // The change of a sweep is a good estimate of the residual, and costs nothing.
    double residual = change * residual_per_change;
    if (residual <= 2.0 * target) {
      residual = system.residual(iteration.current);
      residual_per_change = residual / change;
    }
    note_iteration(system, iteration.options, "sweep",
                   iteration.options.record ? system.residual(iteration.current) : residual, iteration.current.reaction,
                   iteration.solution);
    best = std::min(best, residual);
    const bool arrived = residual <= target;
    if (arrived || residual < rough_digits * exact_residual) {
      system.evaluate(iteration.current);
      accelerated_.correct(iteration.current.motion);
      exact_residual = residual;
      if (arrived && iteration.is_done(iteration.current)) return true;
      if (arrived && ++verdicts == verdict_limit) break;
    }
    if (k == 1) second = residual;
    stalled_ = k == 3 && residual > stall * second && newton_cost(iteration, false) < affordable_newton;
    if (stalled_) break;
    double& past = earlier[std::size_t(k) % outlook];
    if (k >= int(outlook)) {
      const double rate = std::log(past / best) / double(outlook);
      const double remaining = rate > 0.0 ? std::log(best / target) / rate : std::numeric_limits<double>::infinity();
      if (remaining > newton_cost(iteration, unchanged > 1)) break;
    }
    past = best;
  }
  system.evaluate(iteration.current);
  best_.keep(iteration);
  return iteration.is_done(iteration.current);
}

/// Returns whether the problem is solved. Ends early if two sweeps change no state and Newton's method is to follow.
bool AutomaticSolver::sweep(const ContactIteration& iteration, int sweeps, double damping) {
  sweeps_.restart();
  const bool long_run = sweeps > cold_sweeps;
  const double limit = divergence * std::max(iteration.system.data(), iteration.system.residual(iteration.current));
  int unchanged = 0;
  for (int k = 1; k <= sweeps && unchanged < 2; ++k) {
    const bool changed = sweeps_.sweep(iteration.system, damping, iteration.current);
    const double residual = iteration.system.residual(iteration.current);
    note_iteration(iteration.system, iteration.options, "sweep", residual, iteration.current.reaction,
                   iteration.solution);
    diverges_ = !(residual < limit);
    if (diverges_) break;
    unchanged = changed || long_run ? 0 : unchanged + 1;
    if (!long_run || k % 16 != 0) continue;
    iteration.system.evaluate(iteration.current);
    if (iteration.is_done(iteration.current)) return true;
  }
  iteration.system.evaluate(iteration.current);
  best_.keep(iteration);
  return iteration.is_done(iteration.current);
}

/// Solves with W known by its product alone, by a first-order method that needs no more.
std::string AutomaticSolver::iterate_with_products(const ContactIteration& iteration) {
  if (products_ == nullptr) products_ = make_iterative_contact_solver("accelerated-gradient");
  return products_->iterate(iteration.system, iteration.options, iteration.current, iteration.solution);
}

/// Performs Newton steps from `current` with the line search, then full steps from the best r.
bool AutomaticSolver::newton(const ContactIteration& iteration) {
  best_.restart(iteration);
  if (newton_.run(iteration, true, best_)) return true;
  iteration.current = best_.iterate;
  if (newton_.run(iteration, false, best_)) return true;
  iteration.current = best_.iterate;
  return iteration.is_loosely_solved(best_.iterate, on_law_);
}

/// Alternates sweeps and Newton's method, from `current`.
bool AutomaticSolver::alternate(const ContactIteration& iteration, int sweeps, double damping) {
  best_.restart(iteration);
  double tried = std::numeric_limits<double>::infinity();  // merit from which full steps have failed
  for (int alternation = 1; alternation <= alternation_limit; ++alternation) {
    if (sweeps > 0 && sweep(iteration, sweeps, damping)) return true;
    if (diverges_) return false;
    if (newton_.run(iteration, true, best_)) return true;
    iteration.current = best_.iterate;
    if (best_.merit < tried) {
      tried = best_.merit;
      if (newton_.run(iteration, false, best_)) return true;
      iteration.current = best_.iterate;
    }
    if (iteration.is_loosely_solved(best_.iterate, on_law_)) return true;
    sweeps = cold_sweeps << alternation;
  }
  return false;
}

/// Performs accelerated sweeps, then Newton steps if they do not converge.
bool AutomaticSolver::sweeps_and_newton(const ContactIteration& iteration) {
  begin_ = iteration.current.reaction;
  const int before = iteration.solution.iterations;
  const bool solved = accelerated(iteration);
  ContactCosts::update_mean(costs_.of_sweeps, double(iteration.solution.iterations - before) * sweep_cost(iteration));
  if (solved) return true;
  if (is_nearly_closed(iteration.system, iteration.current) && stalled_) {
    // Newton's method does better from the start than from the result of a few sweeps.
    iteration.current.reaction = begin_;
    iteration.system.evaluate(iteration.current);
    best_.restart(iteration);
  }
  iteration.current = best_.iterate;
  return newton(iteration);
}

std::string AutomaticSolver::iterate(const ContactSystem& system, const ContactOptions& options,
                                     ContactIterate& current, ContactSolution& solution) {
  const ContactIteration iteration{system, options, current, solution};
  // Data of an earlier problem must not decide bits of this one.
  diverges_ = false;
  sweeps_.restart();
  newton_.start();
  if (!system.has_entries()) return iterate_with_products(iteration);
  const bool cold = current.reaction.isZero(0.0);
  if (!cold && iteration.is_done(current)) return "";
  if (system.dense() != nullptr && system.is_symmetric() && !has_friction(system)) {
    PrimalDualActiveSet::Watch watch;
    if (options.record) {
      watch = [&](const ContactIterate& now) {
        record_iteration(system, options, "active set", system.residual(now), now.reaction, solution);
      };
    }
    const std::string reason =
        frictionless_.solve(system, options.tolerance, current, solution.iterations, solution.factorizations, watch);
    if (reason.empty()) return "";
    solution.contradiction = frictionless_.contradiction();
    if (!solution.contradiction.empty()) return reason;
  }
  best_.restart(iteration);
  if (cold) best_.merit = std::numeric_limits<double>::infinity();
  if (!cold && costs_.prefer_newton(iteration)) {
    const bool solved = newton_.run(iteration, true, best_);
    ContactCosts::update_mean(costs_.of_newton, newton_.step().work());
    if (solved) return "";
    iteration.current = best_.iterate;
  }
  if (sweeps_and_newton(iteration)) return "";
  if (!system.is_symmetric()) return "Newton's method did not converge with this unsymmetric W";
  if (const std::string reason = find_contradiction(iteration); !reason.empty()) return reason;
  if (!std::isfinite(best_.merit)) return "the iteration diverged: the contact operator is not positive definite";
  if (may_leave_out_twins())
    return "some contact points nearly coincide, and it could not be determined which of them carry the force";
  if (fall_back(iteration, cold)) return "";
  return "none of the methods satisfied the conditions of contact and friction: there may be no solution, or W is not "
         "positive semi-definite";
}

/// Looks for a contradiction of the normal conditions among themselves: friction does not remove it.
std::string AutomaticSolver::find_contradiction(const ContactIteration& iteration) {
  if (iteration.system.dense() == nullptr) return "";
  iteration.current.reaction.setZero();
  int steps = 0;
  const std::string reason = normals_.solve(iteration.system, iteration.current, steps);
  iteration.current = best_.iterate;
  iteration.solution.contradiction = normals_.contradiction();
  return iteration.solution.contradiction.empty() ? "" : reason;
}

void AutomaticSolver::begin_at_zero(const ContactIteration& iteration) {
  iteration.current.reaction.setZero();
  iteration.system.evaluate(iteration.current);
}

void AutomaticSolver::keep_fallback() {
  if (best_.merit < fallback_.merit) fallback_ = best_;
}

/// Tries the fallbacks after sweeps and Newton's method have failed, the cheapest first.
bool AutomaticSolver::fall_back(const ContactIteration& iteration, bool was_cold) {
  fallback_ = best_;
  if (!was_cold) {
    // If contact comes and goes, the last reactions can be a bad start.
    begin_at_zero(iteration);
    best_.restart(iteration);
    best_.merit = std::numeric_limits<double>::infinity();
    newton_.start();
    if (sweeps_and_newton(iteration)) return true;
    keep_fallback();
  }
  if (others_.solve(iteration, OtherSolvers::first, fallback_)) return true;
  iteration.current = fallback_.iterate;
  if (alternate(iteration, cold_sweeps, 1.0)) return true;
  if (diverges_) return false;
  keep_fallback();
  // Strong friction can make full corrections cycle; parts of them, from zero, then often converge.
  for (double damping = 0.5; damping >= smallest_damping; damping *= 0.5) {
    begin_at_zero(iteration);
    if (alternate(iteration, 2 * cold_sweeps, damping)) return true;
    keep_fallback();
  }
  if (others_.solve(iteration, OtherSolvers::last, fallback_)) return true;
  iteration.current = fallback_.iterate;
  return sweep_on(iteration);
}

/// The last resort: Gauss–Seidel for as long as it brings progress, with Newton's method tried now and then. If
/// conditions depend on one another it may creep, and still converge.
bool AutomaticSolver::sweep_on(const ContactIteration& iteration) {
  const double rows = double(iteration.system.rows());
  const int sweeps = int(std::clamp(last_work / (rows * rows), 100.0, 4000.0));
  for (int k = 0; k < last_iterations; ++k) {
    best_.restart(iteration);
    const double before = best_.merit;
    if (sweep(iteration, sweeps, 1.0)) return true;
    if (!(iteration.merit() < 0.5 * before)) break;
    begin_ = iteration.current.reaction;
    if (newton_.run(iteration, false, best_)) return true;
    iteration.current.reaction = begin_;
    iteration.system.evaluate(iteration.current);
  }
  iteration.current = best_.iterate;
  return false;
}

}  // namespace

ContactSolverRegistration automatic_solver() {
  return {"automatic",
          {[] { return std::make_unique<AutomaticSolver>(); },
           "accelerated Gauss-Seidel, then Newton with a line search, then fallbacks; no parameters"}};
}

}  // namespace ricochet
