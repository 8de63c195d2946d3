#pragma once

#include <vector>

#include "ricochet/base/large_vector.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_pattern.hpp"

/// @file Products with a symmetric matrix on the dofs of nodes, at the price of reading about half of it once.
namespace ricochet {

/// A symmetric matrix A with d dofs per node (dof of component k at node i: i·d + k), stored in blocks of d × d with
/// one index each, or, where A = m ⊗ I, in single numbers m that act on d components at once.
///
/// Nodes are taken in consecutive parts (node_parts); the product is quick where near nodes have near numbers. Within a
/// part only the diagonal and what is right of it are stored: an entry that is read serves its row and its column.
/// Entries between two parts are stored in both, so no part writes into another, and all parts can work at once. Sums
/// have an order that depends on the pattern only: products are the same bits for any number of threads.
///
/// Memory is 8 d² + 4 bytes per block (12 for m ⊗ I), of about n (b + 1)/2 blocks for n nodes with b blocks per row:
/// 45 % of the compressed columns of the whole matrix in two and 40 % in three dimensions.
class NodeMatrix {
 public:
  /// A matrix times a factor, of a sum.
  struct Term {
    double factor = 1.0;
    const NodeMatrix* matrix = nullptr;
  };

  NodeMatrix() = default;
  /// From a symmetric matrix stored whole, with d dofs per node. Only what is on one side of the diagonal is read of
  /// some entries, so it must be symmetric to the bit.
  NodeMatrix(const SparseMatrix& matrix, int d);
  /// Σ factor · matrix, in the order of the terms, at least one, all of the same nodes.
  explicit NodeMatrix(const std::vector<Term>& terms);

  [[nodiscard]] Index size() const { return static_cast<Index>(pattern_.node.size()) * dimension_; }
  [[nodiscard]] int dimension() const { return dimension_; }
  /// True where the matrix is m ⊗ I.
  [[nodiscard]] bool is_scalar() const { return stride_ == 1; }
  /// What is stored: the blocks, column by column, in the order of the pattern, and one number more.
  [[nodiscard]] const NodePattern& pattern() const { return pattern_; }
  [[nodiscard]] const LargeVector<double>& values() const { return values_; }
  [[nodiscard]] std::size_t bytes() const;

  /// y = A x. `y` is another vector; it is made of the right size.
  void multiply(const Vector& x, Vector& y) const;
  /// xᵀ A x, without A x: faster than the product.
  [[nodiscard]] double form(const Vector& x) const;

  /// |x|ᵀ |A| |x|.
  [[nodiscard]] double magnitude_form(const Vector& x) const;
  [[nodiscard]] Vector diagonal() const;
  /// The blocks on the diagonal, d² numbers per node.
  [[nodiscard]] Vector diagonal_blocks() const;
  /// True when no entry off the diagonal is other than zero.
  [[nodiscard]] bool is_diagonal() const;
  /// The matrix as it was given: whole, in compressed columns.
  [[nodiscard]] SparseMatrix whole() const;
  /// Its rows and columns of these nodes, ascending, in compressed columns.
  [[nodiscard]] SparseMatrix principal(const std::vector<Index>& nodes) const;
  /// Its columns of these nodes, with all rows, in compressed columns.
  [[nodiscard]] SparseMatrix columns(const std::vector<Index>& nodes) const;

 private:
  template <class Enter>
  void visit_blocks(const Enter& enter) const;
  [[nodiscard]] SparseMatrix extract(const std::vector<int>& row_of, Index rows, const std::vector<int>& column_of,
                                     Index columns) const;
  void read_values(const SparseMatrix& matrix);
  void add_block(Index block, double factor, Index stride, double* sum) const;

  int dimension_ = 2;
  Index stride_ = 1;  ///< numbers per block: d², or 1
  NodePattern pattern_;
  LargeVector<double> values_;  ///< per block: column by column
};

}  // namespace ricochet
