#include "ricochet/linear_algebra/principal_factor.hpp"

#include <cmath>

namespace ricochet {

namespace {
/// Changes of up to 1/8 of the base set border the factor; larger ones lead to a new factor.
constexpr std::size_t part = 8;

/// Number of indices that are in only one of the two sets, both ascending.
std::size_t count_differences(const std::vector<Index>& a, const std::vector<Index>& b) {
  std::size_t common = 0;
  for (auto left = a.begin(), right = b.begin(); left != a.end() && right != b.end();) {
    common += *left == *right ? 1 : 0;
    const bool left_is_behind = *left <= *right, right_is_behind = *right <= *left;
    if (left_is_behind) ++left;
    if (right_is_behind) ++right;
  }
  return a.size() + b.size() - 2 * common;
}

}  // namespace

void PrincipalFactor::reset() {
  base_.clear();
  indices_.clear();
  added_.clear();
  removed_.clear();
}

bool PrincipalFactor::set_base(const Matrix& w, const std::vector<Index>& indices) {
  base_ = indices_ = indices;
  added_.clear();
  removed_.clear();
  common_a_.resize(indices.size());
  for (std::size_t k = 0; k < indices.size(); ++k) common_a_[k] = Index(k);
  common_b_ = common_a_;
  if (indices.empty()) return true;
  const auto count = Index(indices.size());
  Matrix block(count, count);
  for (Index j = 0; j < count; ++j) {
    const double* column = w.data() + indices[std::size_t(j)] * w.rows();
    for (Index i = 0; i < count; ++i) block(i, j) = column[indices[std::size_t(i)]];
  }
  // Scaling makes the square roots, and hence the bits, independent of the unit system.
  const double largest = block.diagonal().maxCoeff();
  scale_ = std::isnormal(largest) ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
  block *= scale_;
  factor_.compute(block);
  if (factor_.info() == Eigen::Success) return true;
  reset();
  return false;
}

void PrincipalFactor::renumber_base(const std::vector<Index>& indices) {
  if (indices == base_) return;
  base_ = indices;
  indices_.clear();
}

bool PrincipalFactor::set_indices(const Matrix& w, const std::vector<Index>& indices) {
  has_factored_ = false;
  if (indices == indices_ && !indices_.empty()) return true;
  const std::size_t changes = count_differences(indices, base_);
  if (!base_.empty() && changes * part <= base_.size() && border(w, indices)) return true;
  has_factored_ = true;
  return set_base(w, indices);
}

bool PrincipalFactor::border(const Matrix& w, const std::vector<Index>& indices) {
  indices_ = indices;
  added_.clear();
  removed_.clear();
  common_a_.clear();
  common_b_.clear();
  std::size_t a = 0, b = 0;
  while (a < indices.size() || b < base_.size()) {
    if (b == base_.size() || (a < indices.size() && indices[a] < base_[b])) {
      added_.push_back(Index(a++));
    } else if (a == indices.size() || base_[b] < indices[a]) {
      removed_.push_back(Index(b++));
    } else {
      common_a_.push_back(Index(a++));
      common_b_.push_back(Index(b++));
    }
  }
  const auto size = Index(base_.size());
  const auto arrivals = Index(added_.size());
  const auto changes = arrivals + Index(removed_.size());
  if (changes == 0) return true;
  border_.setZero(size, changes);
  Matrix schur = Matrix::Zero(changes, changes);
  for (Index k = 0; k < arrivals; ++k) {
    const Index index = indices[std::size_t(added_[std::size_t(k)])];
    const double* column = w.data() + index * w.rows();
    for (Index i = 0; i < size; ++i) border_(i, k) = scale_ * column[base_[std::size_t(i)]];
    for (Index l = 0; l < arrivals; ++l) {
      const Index other = indices[std::size_t(added_[std::size_t(l)])];
      schur(l, k) = scale_ * column[other];
    }
  }
  for (Index k = arrivals; k < changes; ++k) border_(removed_[std::size_t(k - arrivals)], k) = 1.0;
  solved_ = factor_.solve(border_);
  schur.noalias() -= border_.transpose() * solved_;
  if (!schur.allFinite()) return false;
  schur_.compute(schur);
  return true;
}

void PrincipalFactor::solve(const Vector& right, Vector& x) const {
  base_right_.setZero(Index(base_.size()));
  for (std::size_t k = 0; k < common_a_.size(); ++k) base_right_[common_b_[k]] = scale_ * right[common_a_[k]];
  if (base_right_.size() > 0) factor_.solveInPlace(base_right_);
  const auto arrivals = Index(added_.size());
  const auto changes = arrivals + Index(removed_.size());
  x.resize(right.size());
  if (changes > 0) {
    // (S)(x_D, λ) = (b_D, 0) − (W_DB; E_Rᵀ) W_BB⁻¹ b_B.
    border_right_.noalias() = border_.transpose() * base_right_;
    border_right_ = -border_right_;  // a product with a sign would be evaluated into a new vector
    for (Index k = 0; k < arrivals; ++k) border_right_[k] += scale_ * right[added_[std::size_t(k)]];
    border_solution_ = schur_.solve(border_right_);
    base_right_.noalias() -= solved_ * border_solution_;
    for (Index k = 0; k < arrivals; ++k) x[added_[std::size_t(k)]] = border_solution_[k];
  }
  for (std::size_t k = 0; k < common_a_.size(); ++k) x[common_a_[k]] = base_right_[common_b_[k]];
}

}  // namespace ricochet
