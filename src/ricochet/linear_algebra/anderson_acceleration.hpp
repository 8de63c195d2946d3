#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Jacobi>

#include "ricochet/base/ranks.hpp"

/// @file Fixed points x = F(x) of maps that contract slowly or not at all.
namespace ricochet {

/// Anderson acceleration (J. ACM 12, 1965): computes the affine combination of the last points x_j whose residual Σ θ_j
/// f_j is smallest, with f_j = F(x_j) − x_j and Σ θ_j = 1, and continues from Σ θ_j F(x_j). For linear F these are the
/// iterates of GMRES. Storage is reused from one fixed point to the next.
///
/// ΔF = QR has the changes of the residual as columns, oldest first, each divided by its length since they shrink by
/// orders of magnitude, and ΔG those of the image, divided by the same; the next point is F(x) − ΔG γ with Rγ = Qᵀf. A
/// point costs O(depth · n), since Q and R are updated (H. F. Walker and P. Ni, SIAM J. Numer. Anal. 49 (2011)
/// 1715–1735): by classical Gram–Schmidt, twice, for the newest change, and by Givens rotations for one that is
/// discarded. That is the oldest one, or the oldest of those that newer ones nearly span.
class AndersonAcceleration {
 public:
  /// `depth`: number of earlier points in the combination, at least 1.
  explicit AndersonAcceleration(int depth) : depth_(depth) {}
  /// Distributes the vectors over several ranks, each of which has some of the entries. `is_counted` is 1 for an entry
  /// on one of the ranks that have it and 0 on the others. All ranks then call advance() together.
  void distribute(const Ranks& ranks, Vector is_counted);
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

  template <class One, class Other>
  [[nodiscard]] double product(Index begin, const One& one, const Other& other) const;
  template <class Values>
  void add_products(Index begin, const Values& values, Index first);
  template <class Visitor>
  void sum_over_strips(const Visitor& visit);
  /// Qᵀ × the newest change.
  [[nodiscard]] auto coefficients() { return triangle_.col(count_).head(count_); }
  [[nodiscard]] double own_length() const { return std::sqrt(sums_[2 * depth_]); }

  const Ranks* ranks_ = &one_rank();
  Vector is_counted_;  ///< empty: all are
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
  Vector correction_, strip_;
  Vector sums_;  ///< over strips and ranks: Qᵀ × the newest change, Qᵀf, squared length of the newest change
};

}  // namespace ricochet
