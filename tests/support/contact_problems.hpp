#pragma once

#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "ricochet/solver/contact/contact_solver.hpp"
#include "support/sanitized.hpp"

/// @file Contact problems with friction for tests, and a judge of solutions that shares no code with the solver.
namespace ricochet::test {

inline double uniform(std::mt19937& random) {
  return static_cast<double>(random()) / 2147483648.0 - 1.0;
}

inline Vector uniform(Index size, std::mt19937& random) {
  Vector result(size);
  for (double& value : result) value = uniform(random);
  return result;
}

/// A problem with its data in one place.
struct FrictionProblem {
  Matrix w;
  Vector q, rounding, coefficient, bound;
  std::vector<Index> row_offset{0};
  std::vector<char> eligible;

  /// Points of these sizes; W and q are for the caller to fill.
  FrictionProblem(const std::vector<Index>& sizes, double friction);
  [[nodiscard]] Index points() const { return static_cast<Index>(row_offset.size()) - 1; }
  /// As the solvers take it, with this operator or one of its own.
  [[nodiscard]] ContactProblem contact(std::shared_ptr<const ContactOperator> contact_operator = nullptr) const;
};

/// V diag(10^(−digits·k)) Vᵀ with k from 0 to 1 and random V.
Matrix random_operator(Index size, double digits, std::mt19937& random);

/// Points of one row and of `dimension` rows, mixed.
FrictionProblem random_problem(Index points, Index dimension, double friction, unsigned seed, double digits = 1.0);

/// Points on a square, coupled as on an elastic half-space: a decaying normal and tangential influence, and the
/// antisymmetric one of normal on tangential. Pressed by a punch and drawn sideways with a twist.
FrictionProblem half_space_problem(Index side, double friction);

/// A solver by name, which keeps the W of the first problem it is given until `reset`.
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
  /// What it has come to; and the solver then starts its first problem from there.
  [[nodiscard]] Snapshot saved() const {
    Snapshot snapshot;
    solver_->save(snapshot, "solver");
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
  Vector start_reactions_;         ///< likewise
  ContactSolution solution_;
};

/// From a cold start.
ContactSolution solve(const FrictionProblem& problem, const ContactOptions& options = {},
                      const std::string& name = "automatic");

/// The law, point by point, with u computed afresh: cone and signs exactly, alignment and complementarity in u to
/// `tolerance` times the size of the terms of u (W's diagonal is of order one in these problems).
void expect_law(const FrictionProblem& problem, const ContactSolution& solution, double tolerance = 1e-12);

}  // namespace ricochet::test
