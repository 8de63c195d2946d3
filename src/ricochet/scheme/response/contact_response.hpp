#pragma once

#include <string>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/stage_solve.hpp"

/// @file What normal forces on contact points do to these points, through the operator of a stage: for contact laws
/// that are no complementarity, which a scheme solves by itself.
namespace ricochet {

/// Solves a stage with these normal forces and without contact: A δ = b + Gᵀ r + support reactions. The stage is
/// filled but for its contact conditions; its rows are set.
const StageSolution& solve_with_forces(const SemidiscreteProblem& problem, const Vector& normal, std::size_t number,
                                       StageSolve& stages);

/// The body's own stiffness at each contact point, n·Kn/|n|⁴ with its row n of G.
[[nodiscard]] Vector point_stiffness(const SemidiscreteProblem& problem);

/// Warns of a dense matrix of so many rows that a run will be slow or large.
void warn_of_dense_response(const std::string& scheme, Index rows);

/// W = G A⁻¹ Gᵀ with δ = 0 on supported dofs, columns as they are asked for: one solve each, kept as long as their row
/// does not change. For a few hundred points.
class ContactResponse {
 public:
  explicit ContactResponse(std::size_t stage) : number_(stage) {}

  /// W of these points, dense: points × points. Uses the stage; its vectors must be filled afterwards.
  const Matrix& among(const SemidiscreteProblem& problem, const ContactRows& rows, const std::vector<Index>& points,
                      StageSolve& stages);
  /// The operator is another.
  void forget() { columns_.clear(); }
  /// A column of W: all points.
  const Vector& column(const SemidiscreteProblem& problem, const ContactRows& rows, Index point, StageSolve& stages);

 private:
  std::size_t number_;
  std::vector<Vector> columns_;  ///< per point: G A⁻¹ Gᵀ e; empty before it was asked for
  std::vector<long> revision_;   ///< of all rows when the columns were made
  Vector unit_;
  Matrix among_;
};

}  // namespace ricochet
