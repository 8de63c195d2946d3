#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Rows of the stiffness (and the damping) at contact nodes, for schemes that keep these nodes in equilibrium.
namespace ricochet {

class ContactStiffness {
 public:
  /// Assembles stiffness·K_c + damping·C_c, the rows of contact dofs.
  void analyse(const SemidiscreteProblem& problem, double stiffness = 1.0, double damping = 0.0);
  /// Rows, contact dofs × dofs.
  [[nodiscard]] const SparseRowMatrix& rows() const { return rows_; }
  /// Computes result = rows · values for a vector per dof: one entry per problem.contact_dofs.
  void multiply(const Vector& values, Vector& result) const { result.noalias() = rows_ * values; }

 private:
  SparseRowMatrix rows_;
};

}  // namespace ricochet
