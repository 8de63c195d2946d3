#pragma once

#include <vector>

#include "ricochet/solver/contact/alart_curnier.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/contact/gauss_seidel.hpp"
#include "ricochet/solver/contact/newton_iteration.hpp"

/// @file Newton steps of the automatic solver, and the data they share with its sweeps.
namespace ricochet {

/// Sum over the points of the square of Alart and Curnier's residual (contact_point.hpp); infinite if it is not finite.
[[nodiscard]] double contact_merit(const ContactSystem& system, const ContactIterate& iterate);

/// Problem, options, iterate and solution to which the parts of an iteration refer. Three tests of an iterate:
///   is_done            the residual is below the tolerance; with tolerance 0 it is rounding, and q is exact;
///   is_solved_on_law   likewise with its reactions projected on their law, where q need not be exact;
///   is_loosely_solved  with tolerance 0, likewise up to the loosest residual that is accepted.
struct ContactIteration {
  const ContactSystem& system;
  const ContactOptions& options;
  ContactIterate& current;
  ContactSolution& solution;

  [[nodiscard]] double merit() const { return contact_merit(system, current); }
  /// With tolerance 0 the residual must be rounding even if q is exact: Newton's method leaves much less than the
  /// rounding of q, and klr-conserving, which tests whether a gap is zero to rounding, would otherwise open the point.
  [[nodiscard]] bool is_done(const ContactIterate& iterate) const;
  /// Projects the reactions of the iterate on their law (sign, disc of friction), in any case into `on_law`. If the
  /// rounding of q is larger than that of sums, friction may be beyond its limit by as much.
  [[nodiscard]] bool is_solved_on_law(const ContactIterate& iterate, double tolerance, ContactIterate& on_law) const;
  /// The test for the case that nothing improves any more; false if the tolerance is not 0.
  [[nodiscard]] bool is_loosely_solved(const ContactIterate& iterate, ContactIterate& on_law) const;
};

/// Iterate of least merit so far.
struct BestIterate {
  ContactIterate iterate;
  double merit = 0.0;

  /// Restarts from the current iterate.
  void restart(const ContactIteration& iteration);
  /// Keeps the current iterate if it is better. Returns its merit.
  double keep(const ContactIteration& iteration);
};

/// Newton steps (AlartCurnierStep; for a sparse W the same equations with a sparse factor), each cut back until the
/// merit decreases, or full ones.
class GlobalizedNewton {
 public:
  /// Runs from the current iterate. Returns whether it is solved. Without the line search an active set may pass
  /// through a large residual, which some problems require. `best` keeps the iterate of least merit.
  bool run(const ContactIteration& iteration, bool line_search, BestIterate& best);
  /// To be called before a problem: data of an earlier one must not decide its bits.
  void start();
  /// Discards the factors, which are of another W.
  void reset();
  [[nodiscard]] const AlartCurnierStep& step() const { return step_; }
  [[nodiscard]] AlartCurnierStep& step() { return step_; }

 private:
  [[nodiscard]] double next_reduction(const ContactIteration& iteration) const;
  bool full_step(const ContactIteration& iteration, double reduction);
  bool sparse_step(const ContactIteration& iteration);
  bool search_line(const ContactIteration& iteration);
  void smooth(const ContactIteration& iteration);

  AlartCurnierStep step_;
  NewtonSystem sparse_system_;
  std::vector<PointEquation> equations_;
  GaussSeidel sweeps_;
  ContactIterate trial_;    ///< of the full step
  ContactIterate changed_;  ///< of a shortened step, of sweeps, or projected on its law
  double current_merit_ = 0.0;
};

}  // namespace ricochet
