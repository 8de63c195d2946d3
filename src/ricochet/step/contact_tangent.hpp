#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/stage.hpp"

/// @file Derivatives of contact conditions and forces with respect to displacements.
namespace ricochet {

/// Place at which contact conditions are differentiated.
struct ContactPlace {
  const Vector& start;  ///< u₀, from which slips are measured
  const Vector& end;    ///< u₁
  double time;          ///< at the end
  /// Start of the step of which the rows are; null: the rows are those of u₁ alone.
  const StepStart* rows_from = nullptr;
};

/// Derivatives at the end u₁ of a step from u₀, for rows H = [G; B_T] of the step. Against planes they are the rows.
/// Else they are central differences of what ContactGeometry computes, with the error of their width squared: 10⁻¹⁰ for
/// surfaces that bend over the size of the model, and larger for smaller radii. Displacements are perturbed in groups
/// of which no contact point sees two, so that the number of evaluations does not grow with the contact. At points
/// whose gap jumps, because they begin to face something, and at those with constant rows, the derivatives are the
/// rows.
class ContactTangent {
 public:
  /// Differentiates at a place, to which `rows` belong. `reactions`: those of which the force is differentiated.
  void differentiate(const SemidiscreteProblem& problem, const ContactPlace& place, const ContactRows& rows,
                     const Reactions& reactions);

  /// G and B_T of the rows.
  [[nodiscard]] const SparseRowMatrix& normal_rows() const { return normal_rows_; }
  [[nodiscard]] const SparseRowMatrix& tangential_rows() const { return tangential_rows_; }
  /// ∂g/∂u₁, points × dofs, and ∂(B_T (u₁−u₀))/∂u₁, (d−1)·points × dofs.
  [[nodiscard]] const SparseRowMatrix& gap() const { return gap_; }
  [[nodiscard]] const SparseRowMatrix& slip() const { return slip_; }
  /// ∂(Hᵀρ)/∂u₁, dofs × dofs; empty against planes.
  [[nodiscard]] const SparseMatrix& force() const { return force_; }

 private:
  using Triplets = std::vector<Eigen::Triplet<double>>;
  void store_rows(const ContactRows& rows, Index dofs);
  void find_groups(const SemidiscreteProblem& problem, const ContactRows& rows);
  void find_constant_rows(const ContactGeometry& geometry, const ContactPlace& place, Index points);
  void add_kept_rows(const ContactRows& rows);
  void add_differences(const ContactRows& rows, const Reactions& reactions, const std::vector<int>& column_of,
                       double width);

  SparseRowMatrix normal_rows_, tangential_rows_, gap_, slip_;
  SparseMatrix force_;
  std::vector<std::vector<Index>> dofs_of_;  ///< per point, ascending
  std::vector<std::vector<Index>> groups_;   ///< of dofs
  ContactRows forward_, backward_;
  Vector perturbed_, increment_, forward_slip_, backward_slip_;
  std::vector<char> keeps_rows_;  ///< per point: whether its derivatives are its rows
  Vector gap_probe_;
  Triplets gap_entries_, slip_entries_, force_entries_;
};

}  // namespace ricochet
