#pragma once

#include <vector>

#include "ricochet/solver/contact/alart_curnier.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/contact/gauss_seidel.hpp"
#include "ricochet/solver/contact/newton_iteration.hpp"

/// @file Newton steps of the automatic solver, and the data they share with its sweeps.
namespace ricochet {

/// Sum over the points of Alart and Curnier's residual, squared; infinite if it is not finite.
[[nodiscard]] double contact_merit(const ContactSystem& system, const ContactIterate& iterate);

/// Problem, options, iterate and solution that the parts of an iteration work on.
struct ContactWork {
  const ContactSystem& system;
  const ContactOptions& options;
  ContactIterate& current;
  ContactSolution& solution;

  [[nodiscard]] double merit() const { return contact_merit(system, current); }
  [[nodiscard]] bool is_done(const ContactIterate& iterate) const;
  /// Returns whether it is still solved when its reactions are put on their law, as in the result: then in `on_law`.
  [[nodiscard]] bool is_solved_on_law(const ContactIterate& iterate, double tolerance, ContactIterate& on_law) const;
  /// Likewise for the loosest residual that is accepted if rounding is required and nothing improves any more.
  [[nodiscard]] bool is_loosely_solved(const ContactIterate& iterate, ContactIterate& on_law) const;
};

/// Iterate of least merit so far.
struct BestIterate {
  ContactIterate iterate;
  double merit = 0.0;

  /// Restarts from the current iterate.
  void restart(const ContactWork& work);
  /// Keeps the current iterate if it is better. Returns its merit.
  double keep(const ContactWork& work);
};

/// Newton steps (AlartCurnierStep; for a sparse W the same equations with a sparse factor), each cut back until the
/// merit decreases, or full ones.
class GlobalizedNewton {
 public:
  /// Runs from the current iterate. Returns whether it is solved. Without the line search an active set may pass
  /// through a large residual: if conditions depend on one another, two points have to be pressed against each other
  /// until one of them slips.
  bool run(const ContactWork& work, bool line_search, BestIterate& best);
  /// To be called before a problem: data of an earlier one must not decide its bits.
  void start();
  /// Discards the factors, which are of another W.
  void reset();
  [[nodiscard]] const AlartCurnierStep& step() const { return step_; }
  void load_memory(const std::vector<Index>& row_offset, const Snapshot& snapshot, const std::string& name) {
    step_.load_memory(row_offset, snapshot, name);
  }

 private:
  [[nodiscard]] double next_reduction(const ContactWork& work) const;
  bool full_step(const ContactWork& work, double reduction);
  bool sparse_step(const ContactWork& work);
  bool search_line(const ContactWork& work);
  void smooth(const ContactWork& work);

  AlartCurnierStep step_;
  NewtonSystem sparse_system_;
  std::vector<PointEquation> equations_;
  GaussSeidel sweeps_;
  ContactIterate trial_, cut_;
  double current_merit_ = 0.0;
};

}  // namespace ricochet
