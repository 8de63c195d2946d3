#pragma once

#include <memory>
#include <vector>

#include "ricochet/linear_algebra/unsymmetric_factor.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/step/exact_tangent.hpp"
#include "ricochet/step/stage.hpp"

/// @file Contact problem of a step with its exact tangent.
namespace ricochet {

/// Solves the equations of an ExactTangent with a sparse LU factorization of J, condensed on the candidates for
/// contact: y = q + Y J⁻¹ r + W ρ, W = Y J⁻¹ Bᵀ, which need not be symmetric.
///
/// Near a limit of the stability of a body J, and with it W, may be indefinite although contact holds the body.
/// If the contact problem has no solution, the contact stiffness c BᵀY of the points that pressed in the last iteration
/// is added to J and −c Bᵀq to r: with ρ = ρ̃ − c y the solution ρ̃ of these equations is that of the original ones at
/// all points that stay closed, and the others are right in the next iteration.
class ExactStage {
 public:
  explicit ExactStage(const SemidiscreteProblem& problem) : problem_(problem) {}

  /// Computes z and the reactions; `solution` has those of the last iteration. `eligible`: flag per contact point.
  /// Throws Error(not_converged).
  void solve(ExactTangent& tangent, const std::vector<char>& eligible, StageSolution& solution, Vector& unknowns);

  /// Operations of a factorization beyond which solve() refuses the system.
  static constexpr double most_operations = 2e13;

 private:
  struct Row {
    Index at;         ///< point, or row of a tangent
    bool is_tangent;  ///< whether it is the latter
  };
  [[nodiscard]] bool try_solve(const ExactTangent& tangent, const std::vector<char>& eligible,
                               const StageSolution& last, Vector& unknowns);
  void set_warm_start(const StageSolution& last);
  void add_stiffness(const ExactTangent& tangent, const Vector& normal_reaction, ExactTangent& augmented) const;
  void factorize(const ExactTangent& tangent);
  [[nodiscard]] std::vector<Index> penetrating(const ExactTangent& tangent, const std::vector<char>& eligible,
                                               const Vector& unknowns);
  void add_points(const ExactTangent& tangent, const std::vector<Index>& points);
  void make_problem(const ExactTangent& tangent, Matrix& w);
  void find_stiffness(const Matrix& w);
  [[nodiscard]] double along(const ExactTangent& tangent, const Row& row, const auto& unknowns) const;
  [[nodiscard]] Index rows_of(Index point) const;
  void write_solution(StageSolution& solution) const;
  [[noreturn]] void throw_not_solved() const;

  const SemidiscreteProblem& problem_;
  UnsymmetricFactor factor_;
  std::vector<Index> points_;    ///< candidates
  std::vector<char> is_point_;   ///< per contact point
  std::vector<Row> rows_;        ///< of these, one after the other
  std::vector<Vector> columns_;  ///< J⁻¹ Bᵀ of these rows
  double stiffness_ = 0.0;       ///< c
  ContactProblem contact_;
  std::unique_ptr<ContactSolver> solver_;
  ContactSolution contact_solution_;
  Vector free_, right_, gap_;
};

}  // namespace ricochet
