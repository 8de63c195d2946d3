#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file The inverse of a matrix on a set of points that changes by one point after the other. A change costs the
/// square of the number of points.
namespace ricochet {

class PressingSet {
 public:
  /// Of U, to which a reference is kept. Forgets what is known of another one.
  void prepare(const Matrix& u);
  /// The set of the marked points. False where U is singular on it.
  [[nodiscard]] bool take(const std::vector<char>& marks);
  [[nodiscard]] const std::vector<Index>& points() const { return points_; }
  /// r_A = −U_AA⁻¹ q_A, zero elsewhere.
  void solve(const Vector& q, Vector& r);
  /// y += U r for an r that is zero outside of the set.
  void add_motion(const Vector& r, Vector& y) const;
  /// sum += factor · U_AA⁻¹ on the set.
  void add_inverse(double factor, Matrix& sum) const;
  /// Computes the inverse anew: after many changes it has gathered rounding errors. False: singular.
  [[nodiscard]] bool renew();

 private:
  [[nodiscard]] auto inverse() { return inverse_.topLeftCorner(count(), count()); }
  [[nodiscard]] Index count() const { return static_cast<Index>(points_.size()); }
  [[nodiscard]] bool add(Index point);
  [[nodiscard]] bool remove(Index point);

  const Matrix* u_ = nullptr;
  std::vector<Index> points_, places_;  ///< in the order of the inverse; place of each point or −1
  std::vector<Index> added_, removed_;
  Matrix inverse_;  ///< of U_AA, in its leading rows and columns
  Vector column_, row_, on_set_, result_, motion_;
};

}  // namespace ricochet
