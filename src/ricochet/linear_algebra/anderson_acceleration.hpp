#pragma once

#include "ricochet/base/ranks.hpp"

/// @file Fixed points x = F(x) of maps that contract slowly or not at all.
namespace ricochet {

/// Anderson acceleration (J. ACM 12, 1965): computes the affine combination of the last points x_j whose residual Σ θ_j
/// f_j is smallest, with f_j = F(x_j) − x_j and Σ θ_j = 1, and continues from Σ θ_j F(x_j). For linear F these are the
/// iterates of GMRES. Storage is reused from one fixed point to the next.
///
/// A point costs O(depth² · n) and, over ranks, O(depth²) exchanges, which is little for the reactions at contact
/// nodes; QrAndersonAcceleration is made for long vectors.
class AndersonAcceleration {
 public:
  /// `depth`: number of earlier points in the combination, at least 1.
  explicit AndersonAcceleration(int depth) : depth_(depth) {}
  /// Distributes the vectors over several ranks, each of which has some of the entries. `is_counted` is 1 for an entry
  /// on one of the ranks that have it and 0 on the others. All ranks then call advance() together.
  void distribute(const Ranks& ranks, Vector is_counted);
  void restart() { stored_ = -1; }
  /// Sets `next` to the next point; after a restart this is F(x). `next` may be `image`, F(x).
  void advance(const Vector& point, const Vector& image, Vector& next);

 private:
  template <class One, class Other>
  [[nodiscard]] double dot(const One& one, const Other& other) const;
  template <class Values>
  [[nodiscard]] double norm(const Values& values) const;
  void store_changes(const Vector& image);
  void combine(Vector& next);

  const Ranks* ranks_ = &one_rank();
  Vector is_counted_;  ///< empty: all are
  Index depth_;
  Index stored_ = -1, newest_ = 0;           ///< number of stored changes, and column of the newest; −1: no point yet
  Vector image_, residual_, last_residual_;  ///< of the last point
  Matrix image_changes_, residual_changes_;  ///< columns used cyclically
  Matrix directions_, moves_;  ///< orthonormal combinations of residual changes, newest first, and the same
                               ///< combinations of image changes
  Vector remaining_;           ///< remainder of the residual
};

}  // namespace ricochet
