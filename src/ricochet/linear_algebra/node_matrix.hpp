#pragma once

#include <vector>

#include "ricochet/base/large_vector.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_pattern.hpp"

/// @file Products with a symmetric matrix on the dofs of nodes that read about half of it, once.
namespace ricochet {

/// A symmetric matrix A with d dofs per node (dof of component k at node i: i·d + k), stored in blocks of d × d with
/// one index each or, if A = m ⊗ I, as single numbers m that act on d components at once.
///
/// Nodes are divided into consecutive parts (node_parts); products are fast if neighbouring nodes have near numbers.
/// Within a part only the diagonal and the entries right of it are stored: an entry that is read serves its row and its
/// column. Entries between two parts are stored in both, so no part writes into another, and all parts can be processed
/// in parallel. The order of sums depends on the pattern only: products have the same bits for any number of threads.
///
/// Memory is 8 d² + 4 bytes per block (12 for m ⊗ I), with about n (b + 1)/2 blocks for n nodes with b blocks per row:
/// 45 % of the compressed columns of the whole matrix in two and 40 % in three dimensions.
class NodeMatrix {
 public:
  /// A term of a linear combination of matrices.
  struct Term {
    double factor = 1.0;
    const NodeMatrix* matrix = nullptr;
  };

  NodeMatrix() = default;
  /// Converts a symmetric matrix stored whole, with d dofs per node. For some pairs of entries only one is read, so the
  /// matrix must be symmetric to the last bit.
  NodeMatrix(const SparseMatrix& matrix, int d);
  /// Computes Σ factor · matrix in the order of the terms, of which there is at least one, all with the same nodes.
  explicit NodeMatrix(const std::vector<Term>& terms);

  [[nodiscard]] Index size() const { return Index(pattern_.node.size()) * dimension_; }
  [[nodiscard]] int dimension() const { return dimension_; }
  /// Returns whether the matrix is m ⊗ I.
  [[nodiscard]] bool is_scalar() const { return stride_ == 1; }
  /// Storage: the pattern, and the blocks in its order, each in column-major order, followed by one more number.
  [[nodiscard]] const NodePattern& pattern() const { return pattern_; }
  [[nodiscard]] const LargeVector<double>& values() const { return values_; }
  [[nodiscard]] std::size_t bytes() const;

  /// Computes y = A x. `y` must be another vector; it is resized.
  void multiply(const Vector& x, Vector& y) const;
  /// Returns xᵀ A x without computing A x, which is faster.
  [[nodiscard]] double quadratic_form(const Vector& x) const;

  /// Returns |x|ᵀ |A| |x|.
  [[nodiscard]] double absolute_quadratic_form(const Vector& x) const;
  [[nodiscard]] Vector diagonal() const;
  /// Diagonal blocks, d² numbers per node.
  [[nodiscard]] Vector diagonal_blocks() const;
  /// Returns whether all entries off the diagonal are zero.
  [[nodiscard]] bool is_diagonal() const;
  /// Returns the matrix as it was given: whole, in compressed columns.
  [[nodiscard]] SparseMatrix to_sparse() const;
  /// Returns the principal submatrix of these nodes, ascending, in compressed columns.
  [[nodiscard]] SparseMatrix principal(const std::vector<Index>& nodes) const;
  /// Returns the columns of these nodes, with all rows, in compressed columns.
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
  LargeVector<double> values_;  ///< per block, in column-major order
};

}  // namespace ricochet
