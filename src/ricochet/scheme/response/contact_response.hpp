#pragma once

#include <string>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/stage_solve.hpp"

/// @file Response of contact points to normal forces on them through the operator of a stage, for contact laws that are
/// no complementarity problems and that a scheme solves itself.
namespace ricochet {

/// Solves a stage with these normal forces and without contact: A δ = b + Gᵀ r + support reactions. The stage is filled
/// except for its contact conditions; its rows are set.
const StageSolution& solve_with_forces(const SemidiscreteProblem& problem, const Vector& normal, std::size_t number,
                                       StageSolve& stages);

/// Stiffness of the body at each contact point, n·Kn/|n|⁴ with its row n of G.
[[nodiscard]] Vector point_stiffness(const SemidiscreteProblem& problem);

/// Warns that a dense matrix of so many rows makes a run slow or large.
void warn_of_dense_response(const std::string& scheme, Index rows);

/// Delassus operator W = G A⁻¹ Gᵀ with δ = 0 on supported dofs. Columns are computed on demand, one solve each, and
/// kept as long as their row does not change. For a few hundred points.
class ContactResponse {
 public:
  explicit ContactResponse(std::size_t stage) : number_(stage) {}

  /// Dense W of these points, points × points. Uses the stage; its vectors must be filled afterwards.
  const Matrix& among(const SemidiscreteProblem& problem, const ContactRows& rows, const std::vector<Index>& points,
                      StageSolve& stages);
  /// Discards the columns, after a change of the operator.
  void forget() { columns_.clear(); }
  /// Column of W on all points.
  const Vector& column(const SemidiscreteProblem& problem, const ContactRows& rows, Index point, StageSolve& stages);

 private:
  std::size_t number_;
  std::vector<Vector> columns_;  ///< per point: G A⁻¹ Gᵀ e; empty until requested
  std::vector<long> revision_;   ///< of all rows when the columns were computed
  Vector unit_;
  Matrix among_;
};

}  // namespace ricochet
