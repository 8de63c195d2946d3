#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Set of pressing points, found one after the other: the dual method of D. Goldfarb and A. Idnani (Math.
/// Program. 27 (1983) 1–33) for
///   0 ≤ r ⟂ q + U r ≥ 0,
/// U symmetric and positive semi-definite. The points found are independent: U is definite on them, even if other
/// points could press instead.
namespace ricochet {

class PathActiveSet {
 public:
  /// Searches the eligible points. `pressing` is a guess on input, and the result on output. Returns false if no
  /// reactions meet the conditions. A gap above −gap_rounding is no penetration.
  [[nodiscard]] bool find(const Matrix& u, const Vector& q, const std::vector<char>& eligible, double gap_rounding,
                          std::vector<char>& pressing);

 private:
  bool append(const Matrix& u, Index point, double tolerance);
  void factorize(const Matrix& u);
  void remove(const Matrix& u, std::size_t index);
  void solve(Vector& x) const;
  void start(const Matrix& u, const Vector& q);
  bool add_point(const Matrix& u, Index point, double gap);

  std::vector<Index> set_, requested_;
  Matrix factor_;  ///< L of U on the set, L Lᵀ
  Vector row_, reaction_, direction_, gap_;
};

}  // namespace ricochet
