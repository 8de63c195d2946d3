#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The rows of contact nodes of the stiffness (and the damping), for schemes that keep these nodes in
/// equilibrium.
namespace ricochet {

class ContactStiffness {
 public:
  /// stiffness·K_c + damping·C_c, the rows of contact dofs.
  void analyse(const SemidiscreteProblem& problem, double stiffness = 1.0, double damping = 0.0);
  /// Contact dofs × dofs.
  [[nodiscard]] const SparseRowMatrix& rows() const { return rows_; }
  /// result = the rows times a vector per dof: an entry for each of problem.contact_dofs.
  void multiply(const Vector& values, Vector& result) const { result.noalias() = rows_ * values; }

 private:
  SparseRowMatrix rows_;
};

}  // namespace ricochet
