#pragma once

#include <vector>

#include "ricochet/linear_algebra/sparse_cholesky.hpp"

/// @file Columns of the Delassus operator: the contact rows of a stage in the coordinates of its factor.
///
/// With 2ᵏA = PᵀLLᵀP and y = L⁻¹P 2ᵏ b, a row h of H = [G; B_T] has the motion h A⁻¹b = (L⁻¹P hᵀ)·y. The column L⁻¹P hᵀ
/// is zero except on the paths from the dofs of h to the root of the elimination tree: a few separators. So a contact
/// point is represented by short columns Y, and a few points in contact cost little, however many points are on the
/// boundary and wherever their dofs lie in the factor.
namespace ricochet {

class DelassusColumns {
 public:
  /// Keeps a reference to the factor.
  explicit DelassusColumns(const SparseCholesky& factor) : factor_(factor) {}

  [[nodiscard]] Index rows() const { return row_count_; }
  void clear();
  /// Appends rows of H. `transposed` holds them as columns, unknowns of the factor × rows. Extends `w` by the new rows
  /// and columns of YᵀY, symmetric to the bit. Columns that are close in the tree should follow each other.
  void append(const SparseMatrix& transposed, Matrix& w);

  /// Renews the columns of changed rows of H, which may reach other dofs: `transposed` holds all rows, `is_new` marks
  /// the changed ones. `w` is that of all rows. Paths are those of the present rows, independent of earlier ones: the
  /// bits of products depend on them.
  void renew(const SparseMatrix& transposed, const std::vector<char>& is_new, Matrix& w);

  /// Computes Yᵀ y, per row.
  void motion(const Vector& y, Vector& result);
  /// Adds Y r to y; columns of rows with r = 0 are not read.
  void add_reaction(const Vector& r, Vector& y);
  /// Number of entries of Y.
  [[nodiscard]] std::size_t entries() const;

 private:
  /// Columns with nearly the same path, stored on the union of their paths.
  struct Block {
    Index row = 0;  ///< its first row of H
    FactorPath path;
    Matrix columns;
  };
  void append_block(const SparseMatrix& transposed, Index begin, Index end);
  void fill(Block& block, const SparseMatrix& transposed, Index begin) const;
  void find_path(Block& block, const SparseMatrix& transposed, Index begin) const;
  static void add_product(const Block& left, const Block& right, Matrix& w);

  const SparseCholesky& factor_;
  std::vector<Block> blocks_;
  Index row_count_ = 0;
  Vector gathered_;
};

}  // namespace ricochet
