#pragma once

#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "ricochet/solver/contact/contact_solver.hpp"
#include "support/sanitized.hpp"
#include "support/uniform.hpp"

/// @file Contact problems with friction for tests, and a judge of solutions that shares no code with the solver.
namespace ricochet::test_support {

/// A contact problem that owns its data.
struct FrictionProblem {
  Matrix w;
  Vector q, rounding, coefficient, bound;
  std::vector<Index> row_offset{0};
  std::vector<char> eligible;

  /// Makes points of these sizes; the caller fills in W and q.
  FrictionProblem(const std::vector<Index>& sizes, double friction);
  [[nodiscard]] Index points() const { return Index(row_offset.size()) - 1; }
  /// Returns the problem in the solvers' format, with this operator or one of its own.
  [[nodiscard]] ContactProblem contact(std::shared_ptr<const ContactOperator> contact_operator = nullptr) const;
};

/// Returns V diag(10^(−digits·k)) Vᵀ with k from 0 to 1 and random V.
Matrix random_operator(Index size, double digits, std::mt19937& random);

/// Makes points with one row and points with `dimension` rows, mixed.
FrictionProblem random_problem(Index points, Index dimension, double friction, unsigned seed, double digits = 1.0);

/// Makes points on a square, coupled as on an elastic half-space: a decaying normal and tangential influence, and the
/// antisymmetric influence of normal on tangential motion. A punch presses them and draws them sideways with a twist.
FrictionProblem half_space_problem(Index side, double friction);

/// A solver by name, which keeps the W of the first problem until `reset`.
class ContactRun {
 public:
  explicit ContactRun(const std::string& name = "automatic") : solver_(make_contact_solver(name)) {}
  const ContactSolution& solve(const FrictionProblem& problem, const ContactOptions& options = {});
  void reset() {
    operator_.reset();
    start_.reset();
    start_reactions_.resize(0);
  }
  [[nodiscard]] const ContactSolution& solution() const { return solution_; }
  /// Returns the state of the solver; start_with makes a solver start its first problem from it.
  [[nodiscard]] Snapshot saved() const {
    Snapshot snapshot;
    solver_->persist(snapshot.saver("solver"));
    return snapshot;
  }
  void start_with(Snapshot snapshot) { start_ = std::move(snapshot); }
  void set_warm_start(const Vector& reactions) {
    start_reactions_ = reactions;
    if (operator_ != nullptr) solver_->set_warm_start(reactions);
  }

 private:
  std::unique_ptr<ContactSolver> solver_;
  std::shared_ptr<const ContactOperator> operator_;
  std::optional<Snapshot> start_;  ///< for the first problem
  Vector start_reactions_;         ///< for the first problem
  ContactSolution solution_;
};

/// Solves from a cold start.
ContactSolution solve(const FrictionProblem& problem, const ContactOptions& options = {},
                      const std::string& name = "automatic");

/// Checks the contact law point by point, with u recomputed: cone and signs exactly, alignment and complementarity in u
/// up to `tolerance` times the size of the terms of u (W's diagonal is of order one in these problems).
void expect_law(const FrictionProblem& problem, const ContactSolution& solution, double tolerance = 1e-12);

}  // namespace ricochet::test_support
