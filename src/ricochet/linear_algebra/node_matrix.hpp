#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/node_order.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_pattern.hpp"

/// @file Products with a symmetric matrix on the dofs of nodes, at the price of reading about half of it once.
namespace ricochet {

struct NodeRows;

/// A symmetric matrix A with d dofs per node (dof of component k at node i: i·d + k), stored in blocks of d × d with
/// one index each, or, where A = m ⊗ I, in single numbers m that act on d components at once.
///
/// Rows are in the order of a NodeOrder. Within a part of it only the diagonal and what is right of it are stored: an
/// entry that is read serves its row and its column. Entries between two parts are stored in both, so no part writes
/// into another, and all parts can work at once. Sums have an order that depends on the positions of the nodes only:
/// products are the same bits for any number of threads.
///
/// Memory is 8 d² + 4 bytes per block (12 for m ⊗ I), of about n (b + 1)/2 blocks for n nodes with b blocks per row:
/// 45 % of the compressed columns of the whole matrix in two and 40 % in three dimensions.
class NodeMatrix {
 public:
  NodeMatrix() = default;
  /// From a symmetric matrix stored whole, d · order.size() square. Only what is on one side of the diagonal is read of
  /// some entries, so it must be symmetric to the bit.
  NodeMatrix(const SparseMatrix& matrix, int d, std::shared_ptr<const NodeOrder> order);

  [[nodiscard]] const NodeOrder& order() const { return *order_; }
  [[nodiscard]] std::shared_ptr<const NodeOrder> shared_order() const { return order_; }
  [[nodiscard]] Index size() const { return order_ ? order_->size() * dimension_ : 0; }
  /// True where the matrix is m ⊗ I.
  [[nodiscard]] bool is_scalar() const { return stride_ == 1; }
  [[nodiscard]] std::size_t bytes() const;

  /// y = A x. Allocates on the first call only (here and below).
  void multiply(const Vector& x, Vector& y) const;
  /// xᵀ A x, without A x: faster than the product.
  [[nodiscard]] double form(const Vector& x) const;

  /// The same for vectors in the order of this matrix: the dofs of the node at place i are i·d …
  void multiply_ordered(const Vector& x, Vector& y) const;
  [[nodiscard]] double form_ordered(const Vector& x) const;
  /// To that order and back.
  void to_order(const Vector& x, Vector& ordered) const;
  void from_order(const Vector& ordered, Vector& x) const;

  [[nodiscard]] Vector diagonal() const;
  /// True when no entry off the diagonal is other than zero.
  [[nodiscard]] bool is_diagonal() const;
  /// The matrix as it was given: whole, in compressed columns.
  [[nodiscard]] SparseMatrix whole() const;

 private:
  [[nodiscard]] NodeRows rows_of(Index part) const;
  template <class Enter>
  void visit_rows(Index first_part, Index end_part, const Enter& enter) const;
  template <class Enter>
  void visit_blocks(const Enter& enter) const;
  void read_values(const SparseMatrix& matrix);

  int dimension_ = 2;
  Index stride_ = 1;  ///< numbers per block: d², or 1
  std::shared_ptr<const NodeOrder> order_;
  NodePattern pattern_;
  std::vector<double> values_;  ///< per block: column by column
  mutable Vector ordered_x_, ordered_y_;
};

}  // namespace ricochet
