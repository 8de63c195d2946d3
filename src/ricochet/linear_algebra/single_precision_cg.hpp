#pragma once

#include <vector>

#include "ricochet/linear_algebra/conjugate_gradients.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"

/// @file Conjugate gradients in single precision, for the inner iterations of a solve in double precision.
namespace ricochet {

/// Conjugate gradients on Â = L⁻¹ A L⁻ᵀ with D = L Lᵀ, the d × d diagonal blocks of A: D is the preconditioner, applied
/// to the matrix in advance. An iteration reads two fifths of the memory of one in double precision. The solution is
/// accurate to a few digits; a caller that computes its residual in double precision and solves again obtains the
/// others.
class SinglePrecisionCg {
 public:
  /// Scales a matrix in blocks, of which a reference is kept, by its diagonal blocks, d² numbers per node. `solved` per
  /// dof: rows and columns of other dofs are left out. Each of several ranks has a part of the matrix, and the full
  /// values of the vectors and of the diagonal at its nodes.
  SinglePrecisionCg(const NodeMatrix& matrix, const Vector& diagonal_blocks, const std::vector<char>& solved,
                    const Ranks& ranks = one_rank());

  /// Adds to x an approximation of A⁻¹ r, iterating until √(rᵀD⁻¹r) has been reduced by this factor, as estimated in
  /// single precision.
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
  std::vector<float> inverse_factor_;  ///< L⁻¹ per node, in column-major order
  Numbers x_, residual_, direction_, image_;
};

}  // namespace ricochet
