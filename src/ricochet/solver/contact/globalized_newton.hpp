#pragma once

#include <vector>

#include "ricochet/solver/contact/alart_curnier.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/contact/gauss_seidel.hpp"
#include "ricochet/solver/contact/newton_iteration.hpp"

/// @file The Newton steps of the automatic solver, and what they and its sweeps have in common.
namespace ricochet {

/// Sum over the points of Alart and Curnier's residual, squared; infinite where it is not a number.
[[nodiscard]] double contact_merit(const ContactSystem& system, const ContactIterate& iterate);

/// What the parts of an iteration work on.
struct ContactWork {
  const ContactSystem& system;
  const ContactOptions& options;
  ContactIterate& current;
  ContactSolution& solution;

  [[nodiscard]] double merit() const { return contact_merit(system, current); }
  [[nodiscard]] bool is_done(const ContactIterate& iterate) const;
  /// Whether it is still solved when its reactions are put on their law, as it is handed over: then in `on_law`.
  [[nodiscard]] bool is_solved_on_law(const ContactIterate& iterate, double tolerance, ContactIterate& on_law) const;
  /// Where rounding is asked for and nothing improves any more: the same for the loosest residual that is accepted.
  [[nodiscard]] bool is_loosely_solved(const ContactIterate& iterate, ContactIterate& on_law) const;
};

/// The iterate of least merit so far.
struct BestIterate {
  ContactIterate iterate;
  double merit = 0.0;

  /// From here on.
  void restart(const ContactWork& work);
  /// Takes the current iterate where it is better; its merit.
  double keep(const ContactWork& work);
};

/// Newton steps (AlartCurnierStep; where W is sparse the same equations by a sparse factor), each cut back until the
/// merit decreases, or whole ones.
class GlobalizedNewton {
 public:
  /// From the current iterate. True: solved. Without the line search an active set may pass through a large residual:
  /// where conditions depend on one another, two points have to be pressed against each other until one of them slips.
  bool run(const ContactWork& work, bool line_search, BestIterate& best);
  /// Before a problem: what an earlier one leaves behind must not decide bits of this one.
  void start();
  /// The factors are of another W.
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
