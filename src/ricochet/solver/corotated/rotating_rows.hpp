#pragma once

#include <vector>

#include "ricochet/contact/contact_rows.hpp"

/// @file Rows H of contact candidates whose directions rotate with the motion while their trace is constant: H = D E,
/// where E has the rows c ⊗ e_k for such a point and the rows of H themselves for every other one, and D has the
/// directions n and t. The columns of E are unaffected by rotation, and with K = Y_E Y_Eᵀ of them the Delassus operator
/// is W = D K Dᵀ.
namespace ricochet {

class RotatingRows {
 public:
  /// Appends a point with so many rows of H. `is_rotating`: it has a rotating trace, and d rows of E.
  void append(const ContactRows& rows, Index point, Index row_count, bool is_rotating);
  void clear();

  /// True if some point has rotating directions; otherwise H = E.
  [[nodiscard]] bool any() const { return any_; }
  /// True if those of candidate i rotate, in the order in which they were appended.
  [[nodiscard]] bool rotates(std::size_t i) const { return directions_[i].size() > 0; }
  /// First row of E of candidate i; the total number after the last.
  [[nodiscard]] Index first(std::size_t i) const { return first_[i]; }
  [[nodiscard]] Index size() const { return first_.back(); }
  /// Reads D of candidate i from the rows, if its directions rotate.
  void read_directions(const ContactRows& rows, Index point, std::size_t i);

  /// Returns D K Dᵀ, symmetric to the bit.
  [[nodiscard]] Matrix product(const Matrix& k) const;
  /// Compute D v and Dᵀ r.
  void rotate(const Vector& v, Vector& result) const;
  void rotate_back(const Vector& r, Vector& result) const;

 private:
  template <class From, class To>
  void rotate_point(std::size_t i, const From& v, To& result) const;

  using Directions = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

  std::vector<Directions> directions_;  ///< rows × d; empty: identity
  std::vector<Index> row_{0};           ///< first row of H of each, and the total number
  std::vector<Index> first_{0};
  bool any_ = false;
};

}  // namespace ricochet
