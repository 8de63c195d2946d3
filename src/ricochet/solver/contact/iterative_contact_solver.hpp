#pragma once

#include <string>
#include <vector>

#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/contact/contact_system.hpp"
#include "ricochet/solver/contact/twin_points.hpp"

/// @file What all solvers share: scaling, warm start, the choice of points, the verdict.
namespace ricochet {

/// A solver writes `iterate`; everything it is given is scaled (ContactSystem), and what it returns is judged here by
/// the one measure: no solver can declare a problem solved.
class IterativeContactSolver : public ContactSolver {
 public:
  void analyse(const ContactProblem& problem) override;
  void solve(const ContactProblem& problem, const ContactOptions& options, ContactSolution& solution) override;
  [[nodiscard]] const Vector& warm_start() const override { return warm_reaction_; }
  void set_warm_start(const Vector& reactions) override;
  void save(Snapshot& snapshot, const std::string& name) const override;
  void load(const Snapshot& snapshot, const std::string& name) override;

  /// From `current`, which is evaluated and satisfies the signs and limits of its law, towards a solution: until
  /// system.is_solved(current, tolerance), or for as long as it gets closer. Leaves the best r and its u in `current`.
  /// Returns why it stopped without a solution, or nothing.
  virtual std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                              ContactSolution& solution) = 0;

  /// r on the law: signs and limits hold exactly; where friction is at its limit it is against the slip, to the last
  /// digits where `exactly` is asked for. u does not follow.
  static void put_on_law(const ContactSystem& system, const Vector& motion, bool exactly, Vector& reaction);

 protected:
  /// Why such a problem is not for this solver; empty: it is.
  [[nodiscard]] virtual std::string refuses(const ContactSystem&) const { return {}; }
  /// Another W, or another start: what was kept from earlier problems no longer holds.
  virtual void forget() {}
  /// What besides the reactions is kept from one problem to the next and decides bits (factors that are used again, by
  /// what they were made of), and its return after `forget`, for points with these rows (ContactProblem::row_offset).
  /// Throws as `load` does; the caller then forgets what may have been taken.
  virtual void save_memory(Snapshot&, const std::string& /* name */) const {}
  virtual void load_memory(const std::vector<Index>& /* row_offset */, const Snapshot&, const std::string& /* name */) {
  }
  /// A point whose rows are wanted in the system though it may be open: something kept needs them.
  [[nodiscard]] virtual bool keeps_row(Index /* of the problem, a point's first */) const { return false; }
  /// Solve on the points that move into the obstacle or had a reaction, and take in others when they turn out to
  /// penetrate, instead of on all points.
  [[nodiscard]] virtual bool works_on_candidates() const { return false; }

  /// True if `iterate` should give up before an expensive attempt: some points nearly coincide, and `solve` next tries
  /// one of each group of them. It comes back with all of them if that fails.
  [[nodiscard]] bool may_leave_out_twins() { return has_all_points_ && twins_.any(*analysed_, analysed_row_offset_); }

 private:
  [[nodiscard]] bool is_open(const ContactProblem& problem) const;
  void choose_points(const ContactProblem& problem);
  void start(Vector& reaction) const;
  void finish(const ContactOptions& options);
  void run(const ContactOptions& options, ContactSolution& solution);
  void find_motion(const ContactProblem& problem, ContactSolution& solution) const;
  bool take_in_penetrating(const ContactProblem& problem, const ContactOptions& options,
                           const ContactSolution& solution);
  void solve_on_wanted(const ContactProblem& problem, const ContactOptions& options, bool exchanges,
                       ContactSolution& solution);
  void solve_without_twins(const ContactProblem& problem, const ContactOptions& options, ContactSolution& solution);
  [[nodiscard]] bool is_accepted(const ContactOptions& options) const;
  void judge(const ContactProblem& problem, const ContactOptions& options, ContactSolution& solution);
  void find_status(const ContactProblem& problem, ContactSolution& solution) const;

  ContactSystem system_;
  std::shared_ptr<const ContactOperator> analysed_;
  std::vector<Index> analysed_row_offset_;
  Vector warm_reaction_;
  std::vector<char> wanted_;
  TwinPoints twins_;
  bool has_all_points_ = false;  ///< the system may have points that are nearly one, and nothing else was tried yet
  ContactIterate current_, finished_;
  ContactIterate closest_;          ///< of several passes
  ContactSystem::Measure measure_;  ///< of `finished_`
};

/// As make_contact_solver.
[[nodiscard]] std::unique_ptr<IterativeContactSolver> make_iterative_contact_solver(const std::string& name);

}  // namespace ricochet
