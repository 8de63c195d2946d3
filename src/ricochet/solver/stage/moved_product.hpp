#pragma once

#include <vector>

#include "ricochet/solver/stage/stage_product.hpp"

/// @file Change of A x due to a motion of few nodes.
namespace ricochet {

/// Product A (x − x₀) for x and x₀ that differ at given nodes only: their columns of A are stored separately. For many
/// nodes it is a product with A.
class MovedProduct {
 public:
  /// Prepares for these nodes, ascending. Keeps a reference to the product.
  void make(const StageProduct& product, const std::vector<Index>& nodes, Index all_nodes, int d);
  void clear() { *this = MovedProduct(); }
  /// Sets x₀.
  void begin(const Vector& x);
  /// Computes y = A (x − x₀); on several ranks each has a part of it, as in StageProduct.
  void multiply(const Vector& x, Vector& y);

 private:
  const StageProduct* product_ = nullptr;
  bool is_whole_ = true;   ///< columns are not stored
  std::vector<int> dofs_;  ///< else, those of the columns
  SparseMatrix columns_;
  Vector before_, motion_;
};

}  // namespace ricochet
