#include "ricochet/solver/delassus/contact_basis.hpp"

#include <algorithm>

#include "ricochet/linear_algebra/dense_kernels.hpp"

namespace ricochet {

void ContactBasis::clear() {
  rows_.clear();
  row_of_dof_.clear();
  first_.clear();
  offset_.assign(1, 0);
  any_follows_ = false;
  unused_dofs_ = 0;
}

void ContactBasis::append_candidate(Index rows, bool follows) {
  const auto candidate = Index(first_.size());
  offset_.push_back(offset_.back() + rows);
  first_.push_back(follows ? -1 : size());
  any_follows_ = any_follows_ || follows;
  for (Index k = 0; k < rows && !follows; ++k) rows_.push_back({.candidate = candidate, .row = k});
}

void ContactBasis::append_dofs(const std::vector<int>& dofs) {
  for (const int dof : dofs) {
    if (row_of_dof_.size() <= std::size_t(dof)) row_of_dof_.resize(std::size_t(dof) + 1, -1);
    row_of_dof_[std::size_t(dof)] = int(rows_.size());
    rows_.push_back({.dof = dof});
  }
}

std::vector<int> ContactBasis::dofs() const {
  std::vector<int> result;
  for (const Row& row : rows_)
    if (row.dof >= 0) result.push_back(row.dof);
  return result;
}

void ContactBasis::begin_directions() {
  entries_.clear();
  for (std::size_t i = 0; i < first_.size(); ++i) {
    for (Index k = 0; !follows(i) && k < offset_[i + 1] - offset_[i]; ++k)
      entries_.emplace_back(int(offset_[i] + k), int(first_[i] + k), 1.0);
  }
}

void ContactBasis::add(std::size_t candidate, Index row, Index dof, double value) {
  if (has_dof(dof)) entries_.emplace_back(int(offset_[candidate] + row), row_of_dof_[std::size_t(dof)], value);
}

void ContactBasis::finish_directions() {
  directions_.resize(offset_.back(), size());
  directions_.setFromTriplets(entries_.begin(), entries_.end());
  std::vector<char> is_used(rows_.size(), 0);
  for (const auto& entry : entries_) is_used[std::size_t(entry.col())] = 1;
  unused_dofs_ = std::ranges::count(is_used, 0);
}

/// Combines columns of K to those of K Dᵀ, one at a time, and their entries to those of W above the diagonal.
Matrix ContactBasis::product(const Matrix& k) const {
  Matrix result(offset_.back(), offset_.back());
  Vector half(size());
  for (Index column = 0; column < result.cols(); ++column) {
    half.setZero();
    for (SparseRowMatrix::InnerIterator entry(directions_, column); entry; ++entry) {
      const double factor = entry.value();
      add_columns(size(), 1, k.data() + entry.col() * k.rows(), k.rows(), &factor, half.data());
    }
    for (Index row = 0; row <= column; ++row) {
      double sum = 0.0;
      for (SparseRowMatrix::InnerIterator entry(directions_, row); entry; ++entry)
        sum += entry.value() * half[entry.col()];
      result(row, column) = sum;
    }
  }
  result.triangularView<Eigen::StrictlyLower>() = result.transpose();
  return result;
}

}  // namespace ricochet
