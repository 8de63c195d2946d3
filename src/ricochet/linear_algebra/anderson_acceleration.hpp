#pragma once

#include "ricochet/base/ranks.hpp"

/// @file Fixed points x = F(x) of maps that do not contract, or slowly.
namespace ricochet {

/// Anderson's acceleration (J. ACM 12, 1965): of the last points x_j and residuals f_j = F(x_j) − x_j it takes the
/// affine combination whose residual is least, Σ θ_j f_j, and goes on from Σ θ_j F(x_j), Σ θ_j = 1. For linear F these
/// are the iterates of GMRES. Storage is kept from one use to the next.
class AndersonAcceleration {
 public:
  /// `depth`: earlier points that take part, at least 1.
  explicit AndersonAcceleration(int depth) : depth_(depth) {}
  /// Of several ranks each has some entries of the vectors; `is_counted`: of each entry, 1 on one of the ranks that
  /// have it and 0 on the others. All ranks then go on together.
  void divide(const Ranks& ranks, Vector is_counted);
  void restart() { kept_ = -1; }
  /// `next` becomes the next point, after a restart F(x). It may be `image`, F(x).
  void advance(const Vector& point, const Vector& image, Vector& next);

 private:
  template <class One, class Other>
  [[nodiscard]] double dot(const One& one, const Other& other) const;
  template <class Values>
  [[nodiscard]] double norm(const Values& values) const;
  void keep_changes(const Vector& image);
  void combine(Vector& next);

  const Ranks* ranks_ = &one_rank();
  Vector is_counted_;  ///< empty: all are
  Index depth_;
  Index kept_ = -1, newest_ = 0;             ///< changes, and the column of the last one; −1: no point yet
  Vector image_, residual_, last_residual_;  ///< of the last point
  Matrix image_changes_, residual_changes_;  ///< columns in turn
  Matrix directions_, moves_;  ///< orthonormal combinations of residual changes, newest first, and those of images
  Vector left_;                ///< of the residual
};

}  // namespace ricochet
