#pragma once

#include <vector>

#include "ricochet/linear_algebra/conjugate_gradients.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"

/// @file Conjugate gradients in single precision, for the inner iterations of a solve in double precision.
namespace ricochet {

/// On Â = L⁻¹ A L⁻ᵀ with D = L Lᵀ, the d × d diagonal blocks of A: conjugate gradients with D as preconditioner, which
/// has gone into the matrix. An iteration reads two fifths of what one in double precision does. What is found is good
/// to a few digits; a caller that takes its residual in double precision and asks again gets the others.
class SingleGradients {
 public:
  /// Of a matrix in blocks, which is referred to, and its blocks on the diagonal, d² numbers per node; `solved` per
  /// dof: rows and columns of the others are left out. Of several ranks each has a part of the matrix, and the whole of
  /// the vectors and of the diagonal at its nodes.
  SingleGradients(const NodeMatrix& matrix, const Vector& diagonal_blocks, const std::vector<char>& solved,
                  const Ranks& ranks = one_rank());

  /// Adds to x an approximation of A⁻¹ r, after iterations that take √(rᵀD⁻¹r) down to this part of it, as they see it
  /// themselves.
  ConjugateGradients::Result solve(const Vector& residual, double reduction, int iteration_limit, Vector& x);

 private:
  using Numbers = Eigen::VectorXf;

  [[nodiscard]] double multiply();
  [[nodiscard]] double squared_norm(double of_all_nodes) const;
  double scale(const Vector& residual);
  void add_to(Vector& x, double factor) const;

  const NodeMatrix& matrix_;
  const Ranks& ranks_;
  LargeVector<float> values_;          ///< Â, in the pattern of the matrix
  std::vector<float> inverse_factor_;  ///< L⁻¹ per node, column by column
  Numbers x_, residual_, direction_, image_;
};

}  // namespace ricochet
