#pragma once

#include <memory>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/stage.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"

/// @file The contact conditions of a stage, condensed on the contact dofs.
///
/// With A = 2⁻ᵏ Pᵀ L Lᵀ P and the contact dofs last, y = L⁻¹P 2ᵏ b has the trailing part y_c, on which the free contact
/// displacement is L_c⁻ᵀ y_c. With H = [G; B_T] (rows of a point together), a reaction ρ = 2ᵏ (r_N, −r_T) adds L_c⁻¹ Hᵀ
/// ρ to y_c. So with Y = L_c⁻¹ Hᵀ and W = YᵀY the contact problem is stated on
///   (y/s, w/σ) = (q/s, p/σ) + Yᵀy_c + W ρ.
namespace ricochet {

class CondensedContact {
 public:
  /// `position` is per dof: its place among the contact dofs of the factor, or −1 where the stage does not solve for
  /// it. `trailing_factor` is L_c, `scale` is 2ᵏ. Keeps a reference to the problem.
  CondensedContact(const SemidiscreteProblem& problem, const std::vector<int>& position, const Matrix& trailing_factor,
                   double scale);

  /// Finds the reactions and adds Y ρ to y_c. Throws Error(not_converged).
  void solve(const Stage& stage, Eigen::Ref<Vector> trailing, StageSolution& solution);
  /// Called after every contact problem that has been solved; none if empty.
  void observe(ContactObserver observer) { observer_ = std::move(observer); }
  /// In the contact solver, all calls so far.
  [[nodiscard]] double solver_seconds() const { return solver_seconds_; }

 private:
  void number_rows();
  void fill_columns(const std::vector<int>& position, const Matrix& trailing_factor);
  void hold_directions_without_trace(Matrix& w) const;
  void find_offsets(const Stage& stage, const Eigen::Ref<Vector>& trailing);
  void choose_friction(const Stage& stage);
  void solve_contact();
  [[noreturn]] void throw_not_solved() const;

  const SemidiscreteProblem& problem_;
  double scale_;
  bool friction_;
  SparseRowMatrix supported_;   ///< H on supported dofs: rows × supports
  Matrix columns_;              ///< Y, contact dofs × rows
  Vector coefficient_, bound_;  ///< of friction, per point; the bound in units of r
  ContactProblem contact_;      ///< W, q, and the friction of the stage
  std::unique_ptr<ContactSolver> solver_;
  ContactSolution contact_solution_;
  ContactObserver observer_;
  double solver_seconds_ = 0.0;
};

}  // namespace ricochet
