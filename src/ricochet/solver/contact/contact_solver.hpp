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
  /// On the residual (below). Zero: down to rounding.
  double tolerance = 0.0;
  /// Of the solver's own kind (sweeps, Newton steps, …). Zero: the solver's own limit. "automatic" has several kinds of
  /// its own limits and does not look at it.
  int iteration_limit = 0;
  /// Keep a record of every iteration.
  bool record = false;

  /// Throws Error(invalid_input) unless 0 <= tolerance < 1 and the limit is not negative.
  void validate() const;
};

enum class ContactOutcome : char {
  solved,          ///< the residual is below the tolerance, or is rounding
  not_converged,   ///< after the largest number of iterations, or because nothing improves any more
  not_applicable,  ///< the solver does not treat such problems: reason says why
  invalid_data,    ///< q or W not finite, W with a negative diagonal, or reactions beyond the range of numbers
};

/// One line of the record.
struct IterationRecord {
  const char* phase = "";  ///< "sweep", "newton", …
  double residual = 0.0;   ///< after it, relative
  /// Points that press, of those with friction the ones on and off the limit, and points that do another thing than
  /// after the iteration before (before the first: than the reactions it starts from).
  Index closed = 0, slipping = 0, sticking = 0, changed = 0;
};

struct ContactSolution {
  /// r, per row; r_N never negative, |r_T| never beyond the limit by more than rounding, exactly zero where open. Where
  /// the problem is not solved: the best found.
  Vector reaction;
  Vector motion;  ///< u = q + W r, per row
  /// Per point. closed: no friction. stick: |r_T| < b, or u_T is rounding. slip: |r_T| = b to rounding.
  std::vector<ContactStatus> status;
  ContactOutcome outcome = ContactOutcome::not_converged;
  std::string reason;  ///< why not, when not solved
  /// Points whose normal conditions no motion meets together, ascending, where that is why. Only solvers that know the
  /// entries of W look for them.
  std::vector<Index> contradiction;
  /// The measure, see contact_system.hpp: largest natural map of a point over that of r = 0.
  double residual = 0.0;
  /// What of `residual` may be rounding: a residual below it says nothing more.
  double rounding_floor = 0.0;
  int iterations = 0;      ///< all, of every kind
  int newton_steps = 0;    ///< of them, those with a linear system
  int factorizations = 0;  ///< of those, the ones that could not use the factor of an earlier step
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

  /// Takes up W and the points of `problem`; q, F, bounds and eligibility may change until the next call. Forgets the
  /// warm start. Throws Error(invalid_input), see ContactProblem::validate. W must be symmetric: that is not checked.
  virtual void analyse(const ContactProblem& problem) = 0;
  /// Starts from the reactions of the last solved problem, if there is one. Throws Error(invalid_input) where sizes or
  /// options are wrong, not for what the numbers of W and q say: that is in `solution.outcome`. Work space is kept from
  /// call to call.
  virtual void solve(const ContactProblem& problem, const ContactOptions& options, ContactSolution& solution) = 0;

  /// The reactions that the next solve starts from, one per row; empty: from none.
  [[nodiscard]] virtual const Vector& warm_start() const = 0;
  /// After `analyse`. Throws Error(invalid_input) for another length and for numbers that are not finite; the next
  /// start is a cold one then.
  virtual void set_warm_start(const Vector& reactions) = 0;
  /// The reactions, and what else decides bits of the next solve (kept factors, by what they were made of): a solver
  /// that loads it, after `analyse`, goes on with the same bits. `load` throws Error(invalid_input) for what no solver
  /// of its kind has saved on such points; the next start is a cold one then.
  virtual void save(Snapshot& snapshot, const std::string& name) const = 0;
  virtual void load(const Snapshot& snapshot, const std::string& name) = 0;
};

/// Is shown contact problems and what became of them: also those that were not solved.
using ContactObserver = std::function<void(const ContactProblem&, const ContactSolution&)>;

/// By name; throws Error(invalid_input) that lists the names. "automatic" needs no choice.
[[nodiscard]] std::unique_ptr<ContactSolver> make_contact_solver(const std::string& name = "automatic");

class IterativeContactSolver;
struct ContactSolverType {
  std::function<std::unique_ptr<IterativeContactSolver>()> make;
  std::string text;  ///< what it is, one line
};
using ContactSolverRegistration = Registration<ContactSolverType>;
/// All solvers. A program of one's own may add to them; they have no parameters, and so no keys.
[[nodiscard]] Registry<ContactSolverType>& contact_solver_registry();

}  // namespace ricochet
