#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Rows H of contact candidates in a basis that does not follow the motion: H = D E. Rows that follow the motion
/// have a unit row in E for every dof that they reach, all other rows are in E themselves. Columns of E stay what they
/// are while rows rotate and reach other facets, and with K = E A⁻¹ Eᵀ the Delassus operator is W = D K Dᵀ.
namespace ricochet {

class ContactBasis {
 public:
  /// A row of E: that of a dof, or row `row` of candidate `candidate` in H.
  struct Row {
    int dof = -1;
    Index candidate = -1, row = 0;
  };

  void clear();
  /// Appends a candidate with so many rows of H, and its rows to E unless it `follows` the motion.
  void append_candidate(Index rows, bool follows);
  /// Whether rows of some candidate follow the motion; else H = E.
  [[nodiscard]] bool any_follows() const { return any_follows_; }
  [[nodiscard]] bool follows(std::size_t candidate) const { return first_[candidate] < 0; }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  [[nodiscard]] Index size() const { return Index(rows_.size()); }
  /// Dofs of the unit rows, in their order.
  [[nodiscard]] std::vector<int> dofs() const;
  /// Number of unit rows that D does not use.
  [[nodiscard]] Index unused_dofs() const { return unused_dofs_; }
  /// First row in E of a candidate that does not follow the motion.
  [[nodiscard]] Index first(std::size_t candidate) const { return first_[candidate]; }
  [[nodiscard]] bool has_dof(Index dof) const {
    return std::size_t(dof) < row_of_dof_.size() && row_of_dof_[std::size_t(dof)] >= 0;
  }
  /// Appends unit rows, of dofs that have none.
  void append_dofs(const std::vector<int>& dofs);

  /// Begins D anew, with the rows of all candidates in E; then takes the entries of rows that follow the motion. Dofs
  /// without a row of E are left out.
  void begin_directions();
  void add(std::size_t candidate, Index row, Index dof, double value);
  void finish_directions();

  /// Returns D K Dᵀ, symmetric to the bit.
  [[nodiscard]] Matrix product(const Matrix& k) const;
  /// Compute D v and Dᵀ r.
  void to_rows(const Vector& v, Vector& result) const { result.noalias() = directions_ * v; }
  void to_basis(const Vector& r, Vector& result) const { result.noalias() = directions_.transpose() * r; }

 private:
  std::vector<Row> rows_;
  std::vector<int> row_of_dof_;   ///< in E; −1: none
  std::vector<Index> first_;      ///< per candidate, in E; −1: it follows the motion
  std::vector<Index> offset_{0};  ///< per candidate, in H, and the total number
  bool any_follows_ = false;
  Index unused_dofs_ = 0;
  SparseRowMatrix directions_;  ///< D
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace ricochet
