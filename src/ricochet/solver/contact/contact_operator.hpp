#pragma once

#include <functional>
#include <memory>

#include "ricochet/base/types.hpp"
#include "ricochet/solver/contact/contact_point.hpp"

/// @file Delassus operator W of the contact problem: dense, block-sparse, or only its product with a vector.
namespace ricochet {

/// Symmetric positive semi-definite matrix on the rows of contact points (normal first, then tangents).
class ContactOperator {
 public:
  virtual ~ContactOperator() = default;
  ContactOperator() = default;
  ContactOperator(const ContactOperator&) = delete;
  ContactOperator& operator=(const ContactOperator&) = delete;

  [[nodiscard]] virtual Index rows() const = 0;
  /// Computes y = W x.
  virtual void multiply(const Vector& x, Vector& y) const = 0;
  /// Diagonal block of the rows first … first + size − 1, which belong to one point.
  [[nodiscard]] virtual PointMatrix block(Index first, Index size) const = 0;
  /// The whole matrix if it is stored so, otherwise null.
  [[nodiscard]] virtual const Matrix* dense() const { return nullptr; }
  /// The matrix in compressed columns if it is stored so, otherwise null.
  [[nodiscard]] virtual const SparseMatrix* sparse() const { return nullptr; }
};

/// Throws Error(invalid_input) if W is not square.
[[nodiscard]] std::shared_ptr<ContactOperator> make_dense_operator(Matrix w);
/// Makes an operator from compressed columns, duplicates summed, both triangles present; stored by blocks of points
/// when problems are solved with it. Throws Error(invalid_input) if W is not square.
[[nodiscard]] std::shared_ptr<ContactOperator> make_sparse_operator(SparseMatrix w);
/// Makes an operator known only by its product y = W x; y comes with as many zeros as W has rows. Up to 3000 rows all
/// entries are computed by products with unit vectors when the problem is analysed; beyond that only its diagonal
/// blocks (as many products: derive from ContactOperator and define `block` if they are known), and solvers that need
/// more report it. Throws Error(invalid_input) without a product, or if it returns another number of entries.
[[nodiscard]] std::shared_ptr<ContactOperator> make_product_operator(
    Index rows, std::function<void(const Vector& x, Vector& y)> product);

}  // namespace ricochet
