#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/contact_status.hpp"
#include "ricochet/base/registry.hpp"
#include "ricochet/base/snapshot.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/solver/contact/contact_problem.hpp"

/// @file Solvers of the contact problem. To add one: a file with a class derived from IterativeContactSolver
/// (iterative_contact_solver.hpp) and its registration, and one line in registry.cpp, from which the tests take its
/// name.
///
///     ContactProblem problem(3, w, q, 0.3);        // W dense, three rows per point: normal, two tangents
///     const auto solver = make_contact_solver("automatic");
///     ContactSolution solution;
///     solver->analyse(problem);                    // once per W
///     solver->solve(problem, {.tolerance = 1e-8}, solution);
///     if (!solution.solved()) std::cerr << solution.reason << ", residual " << solution.residual << '\n';
///     problem.offset = next_q;                     // the next step
///     solver->solve(problem, {.tolerance = 1e-8}, solution);  // starts from the last reactions
///     std::cout << solution.reaction << '\n';
namespace ricochet {

struct ContactOptions {
  /// Tolerance of the residual (below). Zero: down to rounding.
  double tolerance = 0.0;
  /// Limit on iterations of the solver's own kind (sweeps, Newton steps, …). Zero: the solver's own limit. "automatic"
  /// has several kinds with their own limits and ignores it.
  int iteration_limit = 0;
  /// Keeps a record of every iteration.
  bool record = false;

  /// Throws Error(invalid_input) unless 0 <= tolerance < 1 and the limit is not negative.
  void validate() const;
};

enum class ContactOutcome : char {
  solved,          ///< the residual is below the tolerance, or is rounding
  not_converged,   ///< at the largest number of iterations, or for lack of progress
  not_applicable,  ///< the solver does not treat such problems: see reason
  invalid_data,    ///< q or W not finite, W with a negative diagonal, or reactions beyond the range of numbers
};

/// One line of the record.
struct IterationRecord {
  const char* phase = "";  ///< "sweep", "newton", …
  double residual = 0.0;   ///< after the iteration, relative
  /// Numbers of points that press; of points with friction those at the limit and below it; and of points whose state
  /// differs from that after the previous iteration (at the first: from that of the starting reactions).
  Index closed = 0, slipping = 0, sticking = 0, changed = 0;
};

struct ContactSolution {
  /// r, per row; r_N never negative, |r_T| never beyond the limit by more than rounding, exactly zero at open points.
  /// If the problem is not solved: the best found.
  Vector reaction;
  Vector motion;  ///< u = q + W r, per row
  /// Per point. closed: no friction. stick: |r_T| < b, or u_T is rounding. slip: |r_T| = b to rounding.
  std::vector<ContactStatus> status;
  ContactOutcome outcome = ContactOutcome::not_converged;
  std::string reason;  ///< of a failure; else empty
  /// Points whose normal conditions no motion meets together, ascending, if that is the reason. Only solvers that know
  /// the entries of W look for them.
  std::vector<Index> contradiction;
  /// The measure, see contact_system.hpp: largest natural map of a point over that of r = 0.
  double residual = 0.0;
  /// Part of `residual` that may be rounding: a smaller residual carries no information.
  double rounding_floor = 0.0;
  int iterations = 0;      ///< of every kind
  int newton_steps = 0;    ///< steps with a linear system
  int factorizations = 0;  ///< steps that could not use the factor of an earlier one
  std::vector<IterationRecord> record;
  std::vector<ContactStatus> record_status;  ///< per point, after the last iteration of the record: work space

  [[nodiscard]] bool solved() const { return outcome == ContactOutcome::solved; }
};

class ContactSolver {
 public:
  virtual ~ContactSolver() = default;
  ContactSolver() = default;
  ContactSolver(const ContactSolver&) = delete;
  ContactSolver& operator=(const ContactSolver&) = delete;

  /// Analyses W and the points of `problem`; q, F, bounds and eligibility may change until the next call. Discards the
  /// warm start. Throws Error(invalid_input), see ContactProblem::validate. W must be
  /// symmetric unless ContactProblem::is_symmetric is false, which is not checked.
  virtual void analyse(const ContactProblem& problem) = 0;
  /// Starts from the reactions of the last solved problem, if there is one. Throws Error(invalid_input) if sizes or
  /// options are wrong; invalid values of W and q are reported in `solution.outcome`. Work space is kept from call to
  /// call.
  virtual void solve(const ContactProblem& problem, const ContactOptions& options, ContactSolution& solution) = 0;

  /// Reactions from which the next solve starts, one per row; empty if none.
  [[nodiscard]] virtual const Vector& warm_start() const = 0;
  /// Sets them, after `analyse`. Throws Error(invalid_input) for another length and for numbers that are not finite;
  /// the next start is then a cold one.
  virtual void set_warm_start(const Vector& reactions) = 0;
  /// Saves and loads the reactions and everything else that decides bits of the next solve (kept factors, by the data
  /// they were made of): a solver that loads them, after `analyse`, continues with the same bits. Loading throws
  /// Error(invalid_input) for data that no solver of its kind has saved for such points; the next start is then a cold
  /// one.
  virtual void persist(const SnapshotVisitor& visit) = 0;
};

/// Observer of contact problems and their results, including those that were not solved.
using ContactObserver = std::function<void(const ContactProblem&, const ContactSolution&)>;

/// Makes a solver by name; throws Error(invalid_input), which lists the names. "automatic" needs no choice.
[[nodiscard]] std::unique_ptr<ContactSolver> make_contact_solver(const std::string& name = "automatic");

class IterativeContactSolver;
struct ContactSolverType {
  std::function<std::unique_ptr<IterativeContactSolver>()> make;
  std::string text;  ///< description, one line
};
using ContactSolverRegistration = Registration<ContactSolverType>;
/// Registry of all solvers. Programs may add their own; they have no parameters, and so no keys.
[[nodiscard]] Registry<ContactSolverType>& contact_solver_registry();

}  // namespace ricochet
