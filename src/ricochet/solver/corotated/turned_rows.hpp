#pragma once

#include <vector>

#include "ricochet/contact/contact_rows.hpp"

/// @file Rows H of candidates for contact whose directions turn with the motion while their trace does not change:
/// H = D E, where E has for such a point the rows c ⊗ e_k, for every other one the rows of H themselves, and D the
/// directions n and t. The columns of E outlast all turning, and with K = Y_E Y_Eᵀ of them W = D K Dᵀ.
namespace ricochet {

class TurnedRows {
 public:
  /// Appends a point with so many rows of H. `turns`: it has a turning trace, and d rows of E.
  void append(const ContactRows& rows, Index point, Index row_count, bool turns);
  void clear();

  /// Some point turns; else H = E.
  [[nodiscard]] bool any() const { return any_; }
  /// Candidate i, in the order in which they were appended.
  [[nodiscard]] bool turns(std::size_t i) const { return directions_[i].size() > 0; }
  /// Its first row of E; the number of all after the last.
  [[nodiscard]] Index first(std::size_t i) const { return first_[i]; }
  [[nodiscard]] Index size() const { return first_.back(); }
  /// Reads D of candidate i from the rows, where it turns.
  void take(const ContactRows& rows, Index point, std::size_t i);

  /// D K Dᵀ, symmetric to the bit.
  [[nodiscard]] Matrix product(const Matrix& k) const;
  /// D v and Dᵀ r.
  void turn(const Vector& v, Vector& result) const;
  void turn_back(const Vector& r, Vector& result) const;

 private:
  template <class From, class To>
  void turn_point(std::size_t i, const From& v, To& result) const;

  using Directions = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

  std::vector<Directions> directions_;  ///< rows × d; empty: 1
  std::vector<Index> row_{0};           ///< the first row of H of each, and their number
  std::vector<Index> first_{0};
  bool any_ = false;
};

}  // namespace ricochet
