#pragma once

#include <vector>

#include "ricochet/solver/stage/stage_product.hpp"

/// @file What a motion of few nodes changes in A x.
namespace ricochet {

/// A (x − x₀), where x and x₀ differ at given nodes only: their columns of A are kept apart. Where the nodes are many
/// that is a product with A.
class MovedProduct {
 public:
  /// Of these nodes, ascending. Keeps a reference to the product.
  void make(const StageProduct& product, const std::vector<Index>& nodes, Index all_nodes, int d);
  void clear() { *this = MovedProduct(); }
  /// x₀.
  void begin(const Vector& x);
  /// y = A (x − x₀); of several ranks each has a part of it, as in StageProduct.
  void multiply(const Vector& x, Vector& y);

 private:
  const StageProduct* product_ = nullptr;
  bool is_whole_ = true;   ///< columns are not kept
  std::vector<int> dofs_;  ///< else, of the columns
  SparseMatrix columns_;
  Vector before_, motion_;
};

}  // namespace ricochet
