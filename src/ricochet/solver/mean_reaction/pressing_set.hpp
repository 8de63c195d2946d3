#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Inverse of a matrix on a set of points that changes by one point at a time. A change costs the square of the
/// number of points.
namespace ricochet {

class PressingSet {
 public:
  /// Sets U, to which a reference is kept. Discards the data of another one.
  void prepare(const Matrix& u);
  /// Changes the set to the marked points. Returns false if U is singular on it.
  [[nodiscard]] bool set_points(const std::vector<char>& marks);
  [[nodiscard]] const std::vector<Index>& points() const { return points_; }
  /// Computes r_A = −U_AA⁻¹ q_A, zero elsewhere.
  void solve(const Vector& q, Vector& r);
  /// Adds U r to y, for an r that is zero outside of the set.
  void add_motion(const Vector& r, Vector& y) const;
  /// Adds factor · U_AA⁻¹ on the set to the sum.
  void add_inverse(double factor, Matrix& sum) const;
  /// Recomputes the inverse, which accumulates rounding errors over many changes. Returns false if U_AA is singular.
  [[nodiscard]] bool renew();

 private:
  [[nodiscard]] auto inverse() { return inverse_.topLeftCorner(count(), count()); }
  [[nodiscard]] Index count() const { return Index(points_.size()); }
  [[nodiscard]] bool add(Index point);
  [[nodiscard]] bool remove(Index point);

  const Matrix* u_ = nullptr;
  std::vector<Index> points_, indices_;  ///< in the order of the inverse; index of each point, or −1
  std::vector<Index> added_, removed_;
  Matrix inverse_;  ///< of U_AA, in its leading rows and columns
  Vector column_, row_, on_set_, result_, motion_;
};

}  // namespace ricochet
