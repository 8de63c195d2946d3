#pragma once

#include "ricochet/linear_algebra/node_matrix.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"

/// @file Products with the matrix of a stage.
namespace ricochet {

/// Where A has more entries than so many times those of K, its mass is kept apart.
inline constexpr double most_growth_by_mass = 1.3;

/// Whether it has, over all ranks, which ask together.
[[nodiscard]] bool keeps_mass_apart(const SemidiscreteProblem& problem, const NodeMatrix& stiffness);

/// A = αM + κK + ηC on all dofs. A mass that couples more nodes than the stiffness (an equivalent mass) is not added up
/// with it: one number per pair of nodes is read for it then, and not d².
class StageProduct {
 public:
  StageProduct() = default;
  /// Of the problem, which is referred to, at this displacement; empty: of the undeformed body. Some coefficient is
  /// not zero. Beside A nothing of its size is made where the tangent is constant.
  StageProduct(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
               const Vector& displacement = {});

  /// A given matrix, symmetric to the bit, with d dofs per node.
  StageProduct(const SparseMatrix& matrix, int d) : matrix_(matrix, d) {}

  /// y = A x. Allocates on the first call only.
  void multiply(const Vector& x, Vector& y) const;
  /// The rows and columns of these nodes, ascending, of A.
  [[nodiscard]] SparseMatrix principal(const std::vector<Index>& nodes) const;
  /// The columns of these nodes, with all rows, of A.
  [[nodiscard]] SparseMatrix columns(const std::vector<Index>& nodes) const;
  [[nodiscard]] Vector diagonal() const;
  /// Of A, d² numbers per node. Ranks have a part each.
  [[nodiscard]] Vector diagonal_blocks() const;
  /// A, where it is stored as one matrix; else null.
  [[nodiscard]] const NodeMatrix* matrix() const { return mass_ == nullptr ? &matrix_ : nullptr; }

 private:
  [[nodiscard]] SparseMatrix with_mass(const SparseMatrix& stiffness, SparseMatrix inertia) const;

  NodeMatrix matrix_;                 ///< A, or κK
  const NodeMatrix* mass_ = nullptr;  ///< where M is apart
  double mass_factor_ = 0.0;          ///< α
  mutable Vector inertia_;
};

}  // namespace ricochet
