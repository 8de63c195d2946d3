#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Cholesky factor of a principal submatrix that follows small changes of its index set.
namespace ricochet {

/// Solves W_AA x = b for index sets A that change from call to call. The factor of a base set B is kept; with the added
/// indices D = A∖B and the removed indices R = B∖A, x follows from the bordered system
///   ⎡W_BB W_BD E_R⎤ ⎡x_B⎤   ⎡b_B⎤
///   ⎢W_DB W_DD  0 ⎥ ⎢x_D⎥ = ⎢b_D⎥,   b_R = 0,
///   ⎣E_Rᵀ  0    0 ⎦ ⎣ λ ⎦   ⎣ 0 ⎦
/// by its small Schur complement on (x_D, λ): one solve with the base factor per added or removed index. After many
/// changes A becomes the base.
class PrincipalFactor {
 public:
  /// Sets the index set A (ascending). Returns false if W_AA is not positive definite.
  bool set_indices(const Matrix& w, const std::vector<Index>& indices);
  /// Solves for x; b and x have one entry per index of A.
  void solve(const Vector& right, Vector& x) const;
  void reset();

  /// Base set B, from which a factor with the same bits can be made again if `w` is the same matrix.
  [[nodiscard]] const std::vector<Index>& base() const { return base_; }
  bool set_base(const Matrix& w, const std::vector<Index>& indices);
  /// Renumbers the base set: the same rows of W, in the same order, have these indices now; other rows of W may have
  /// changed.
  void renumber_base(const std::vector<Index>& indices);
  /// Returns whether the last set_indices computed a new factor.
  [[nodiscard]] bool has_factored() const { return has_factored_; }

 private:
  bool border(const Matrix& w, const std::vector<Index>& indices);

  std::vector<Index> base_, indices_;
  Eigen::LLT<Matrix> factor_;
  double scale_ = 1.0;                      ///< power of two that brings the base's largest diagonal entry near one
  std::vector<Index> added_, removed_;      ///< positions of added indices in A, of removed ones in B
  std::vector<Index> common_a_, common_b_;  ///< positions of A∩B in A and in B
  Matrix border_, solved_;                  ///< (W_BD E_R) and its solve with W_BB
  Eigen::PartialPivLU<Matrix> schur_;
  mutable Vector base_right_, border_right_, border_solution_;
  bool has_factored_ = false;
};

}  // namespace ricochet
