#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Jacobi>

#include "ricochet/base/types.hpp"

/// @file Fixed points x = F(x) of maps of many unknowns that contract slowly or not at all.
namespace ricochet {

/// Anderson acceleration (anderson_acceleration.hpp) for long vectors on one rank.
///
/// ΔF = QR has the changes of the residual as columns, oldest first, each divided by its length since they shrink by
/// orders of magnitude, and ΔG those of the image, divided by the same; the next point is F(x) − ΔG γ with Rγ = Qᵀf. A
/// point costs O(depth · n), since Q and R are updated (H. F. Walker and P. Ni, SIAM J. Numer. Anal. 49 (2011)
/// 1715–1735): by classical Gram–Schmidt, twice, for the newest change, and by Givens rotations for one that is
/// discarded. That is the oldest one, or the oldest of those that newer ones nearly span.
class QrAndersonAcceleration {
 public:
  /// `depth`: number of earlier points in the combination, at least 1.
  explicit QrAndersonAcceleration(int depth) : depth_(depth) {}
  void restart() { has_point_ = false; }
  /// Sets `next` to the next point; after a restart this is F(x). `next` may be `image`, F(x).
  void advance(const Vector& point, const Vector& image, Vector& next);

 private:
  void resize(Index size);
  [[nodiscard]] double enter(const Vector& point, const Vector& image);
  void append(double length);
  template <class Parts>
  void subtract(double divisor, const Parts& parts);
  void orthogonalize_again();
  [[nodiscard]] Index oldest_in_span();
  void discard(Index column);
  void apply_rotations(Index begin, Index size);
  void return_lost_part();
  void combine(Vector& next);

  template <class Values>
  void add_products(Index begin, const Values& values, Index first);
  template <class Visitor>
  void sum_over_strips(const Visitor& visit);
  /// Qᵀ × the newest change.
  [[nodiscard]] auto coefficients() { return triangle_.col(count_).head(count_); }
  [[nodiscard]] double own_length() const { return std::sqrt(sums_[2 * depth_]); }

  Index depth_;
  bool has_point_ = false;
  Vector image_, residual_;       ///< of the last point
  Index count_ = 0;               ///< number of columns of Q and R; the column that follows is for the newest change
  Matrix directions_, triangle_;  ///< Q, R
  std::vector<Eigen::JacobiRotation<double>> rotations_;  ///< of neighbouring columns of Q, still to be applied
  Index first_rotated_ = 0;
  Matrix image_changes_;      ///< not divided, in any order
  std::vector<Index> slots_;  ///< column of image_changes_ by column of R, then the free ones
  Vector lengths_;            ///< of the changes of the residual, by column of R
  Vector on_residual_;        ///< Qᵀf, then γ
  Vector correction_;
  Vector sums_;  ///< over strips: Qᵀ × the newest change, Qᵀf, squared length of the newest change
};

}  // namespace ricochet
