#include "ricochet/solver/stage/moved_product.hpp"

namespace ricochet {

/// Stored columns are whole, and cost two thirds more than A: more than one per so many nodes are not stored.
constexpr Index nodes_per_column = 16;

void MovedProduct::make(const StageProduct& product, const std::vector<Index>& nodes, Index all_nodes, int d) {
  clear();
  product_ = &product;
  is_whole_ = Index(nodes.size()) * nodes_per_column > all_nodes;
  if (is_whole_) return;
  columns_ = product.columns(nodes);
  for (const Index node : nodes) {
    for (Index dof = node * d; dof < (node + 1) * d; ++dof) dofs_.push_back(int(dof));
  }
  before_.resize(Index(dofs_.size()));
  motion_.resize(before_.size());
}

void MovedProduct::begin(const Vector& x) {
  if (is_whole_) {
    before_ = x;
    return;
  }
  for (std::size_t i = 0; i < dofs_.size(); ++i) before_[Index(i)] = x[dofs_[i]];
}

void MovedProduct::multiply(const Vector& x, Vector& y) {
  if (is_whole_) {
    motion_ = x - before_;
    product_->multiply(motion_, y);
    return;
  }
  for (std::size_t i = 0; i < dofs_.size(); ++i) motion_[Index(i)] = x[dofs_[i]] - before_[Index(i)];
  y.setZero(x.size());
  y.noalias() += columns_ * motion_;
}

}  // namespace ricochet
