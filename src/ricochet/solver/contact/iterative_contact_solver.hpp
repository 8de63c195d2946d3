#pragma once

#include <string>
#include <vector>

#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/contact/contact_system.hpp"
#include "ricochet/solver/contact/twin_points.hpp"

/// @file Base of all solvers: scaling, warm start, the choice of points, the verdict.
namespace ricochet {

/// A solver implements `iterate`; all its input is scaled (ContactSystem), and its result is judged here by the one
/// measure: no solver can declare a problem solved.
class IterativeContactSolver : public ContactSolver {
 public:
  void analyse(const ContactProblem& problem) override;
  void solve(const ContactProblem& problem, const ContactOptions& options, ContactSolution& solution) override;
  [[nodiscard]] const Vector& warm_start() const override { return warm_reaction_; }
  void set_warm_start(const Vector& reactions) override;
  void persist(const SnapshotVisitor& visit) override;

  /// Iterates from `current`, which is evaluated and satisfies the signs and limits of its law, towards a solution:
  /// until system.is_solved(current, tolerance), or for as long as there is progress. Leaves the best r and its u in
  /// `current`. Returns the reason of a failure, or nothing.
  virtual std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                              ContactSolution& solution) = 0;

  /// Puts r on the law: signs and limits hold exactly; friction at its limit is against the slip, to the last digits
  /// with `exactly`. Leaves u unchanged.
  static void put_on_law(const ContactSystem& system, const Vector& motion, bool exactly, Vector& reaction);

 protected:
  /// Reason why the solver does not treat such a problem; empty: it does.
  [[nodiscard]] virtual std::string refuses(const ContactSystem&) const { return {}; }
  /// Discards data kept from earlier problems, for another W or another start.
  virtual void forget() {}
  /// Saves and loads the data that besides the reactions are kept from one problem to the next and decide bits (factors
  /// that are used again, by the data they were made of); loading follows `forget`, for points with these rows
  /// (ContactProblem::row_offset). Throws as `persist` does; the caller then discards partial data.
  virtual void persist_memory(const SnapshotVisitor&, const std::vector<Index>& /* row_offset */) {}
  /// True if kept data require the rows of a point in the system, though it may be open.
  [[nodiscard]] virtual bool keeps_row(Index /* of the problem, a point's first */) const { return false; }
  /// True if the solver works on the points that move into the obstacle or had a reaction, and adds others if they
  /// penetrate, instead of on all points.
  [[nodiscard]] virtual bool works_on_candidates() const { return false; }

  /// True if `iterate` should give up before an expensive attempt: some points nearly coincide, and `solve` next tries
  /// one of each group of them. It returns to all of them if that fails.
  [[nodiscard]] bool may_leave_out_twins() { return has_all_points_ && twins_.any(*analysed_, analysed_row_offset_); }

 private:
  [[nodiscard]] bool is_open(const ContactProblem& problem) const;
  void choose_points(const ContactProblem& problem);
  void start(Vector& reaction) const;
  void finish(const ContactOptions& options);
  void run(const ContactOptions& options, ContactSolution& solution);
  void find_motion(const ContactProblem& problem, ContactSolution& solution) const;
  bool add_penetrating(const ContactProblem& problem, const ContactOptions& options, const ContactSolution& solution);
  void solve_on_selected(const ContactProblem& problem, const ContactOptions& options, bool exchanges,
                         ContactSolution& solution);
  void solve_without_twins(const ContactProblem& problem, const ContactOptions& options, ContactSolution& solution);
  [[nodiscard]] bool is_accepted(const ContactOptions& options) const;
  void judge(const ContactProblem& problem, const ContactOptions& options, ContactSolution& solution);
  void find_status(const ContactProblem& problem, ContactSolution& solution) const;

  ContactSystem system_;
  std::shared_ptr<const ContactOperator> analysed_;
  std::vector<Index> analysed_row_offset_;
  Vector warm_reaction_;
  std::vector<char> selected_;
  TwinPoints twins_;
  bool has_all_points_ = false;  ///< the system may have nearly identical points, and nothing else has been tried yet
  ContactIterate current_, finished_;
  ContactIterate closest_;          ///< of several passes
  ContactSystem::Measure measure_;  ///< of `finished_`
};

/// Makes a solver as make_contact_solver does.
[[nodiscard]] std::unique_ptr<IterativeContactSolver> make_iterative_contact_solver(const std::string& name);

}  // namespace ricochet
