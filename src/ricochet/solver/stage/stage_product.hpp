#pragma once

#include "ricochet/linear_algebra/node_matrix.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/stage.hpp"

/// @file Products with the matrix of a stage.
namespace ricochet {

/// Ratio of the entries of A to those of K above which the mass is kept separate.
inline constexpr double most_growth_by_mass = 1.3;

/// Returns whether the mass is kept separate. Collective over the ranks.
[[nodiscard]] bool keeps_mass_apart(const SemidiscreteProblem& problem, const NodeMatrix& stiffness);

/// Product with A = αM + κK + ηC on all dofs. A mass that couples more nodes than the stiffness (an equivalent mass) is
/// not added to it: one number per pair of nodes is then read for it, instead of d².
class StageProduct {
 public:
  StageProduct() = default;
  /// Assembles A of the problem, to which a reference is kept, at this displacement; empty: of the undeformed body.
  /// Some coefficient is not zero. With a constant tangent nothing of the size of A is made besides it.
  StageProduct(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
               const Vector& displacement = {});

  /// Uses a given matrix, symmetric to the bit, with d dofs per node.
  StageProduct(const SparseMatrix& matrix, int d) : matrix_(matrix, d) {}

  /// Computes y = A x. Allocates on the first call only.
  void multiply(const Vector& x, Vector& y) const;
  /// Rows and columns of A of these nodes, ascending.
  [[nodiscard]] SparseMatrix principal(const std::vector<Index>& nodes) const;
  /// Columns of A of these nodes, with all rows.
  [[nodiscard]] SparseMatrix columns(const std::vector<Index>& nodes) const;
  [[nodiscard]] Vector diagonal() const;
  /// Diagonal blocks of A, d² numbers per node. Ranks have a part each.
  [[nodiscard]] Vector diagonal_blocks() const;
  /// A, if it is stored as one matrix; else null.
  [[nodiscard]] const NodeMatrix* matrix() const { return mass_ == nullptr ? &matrix_ : nullptr; }

 private:
  [[nodiscard]] SparseMatrix with_mass(const SparseMatrix& stiffness, SparseMatrix inertia) const;

  NodeMatrix matrix_;                 ///< A, or κK
  const NodeMatrix* mass_ = nullptr;  ///< M, if separate; else null
  double mass_factor_ = 0.0;          ///< α
  mutable Vector inertia_;
};

}  // namespace ricochet
