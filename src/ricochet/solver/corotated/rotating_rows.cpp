#include "ricochet/solver/corotated/rotating_rows.hpp"

#include <cmath>

namespace ricochet {

void RotatingRows::append(const ContactRows& rows, Index point, Index row_count, bool is_rotating) {
  directions_.emplace_back();
  row_.push_back(row_.back() + row_count);
  first_.push_back(first_.back() + (is_rotating ? rows.dimension() : row_count));
  if (!is_rotating) return;
  any_ = true;
  directions_.back().resize(row_count, rows.dimension());
  read_directions(rows, point, directions_.size() - 1);
}

void RotatingRows::clear() {
  directions_.clear();
  row_.assign(1, 0);
  first_.assign(1, 0);
  any_ = false;
}

/// Uses the entries at the node with the largest part in the trace: rows may be known by their values alone.
void RotatingRows::read_directions(const ContactRows& rows, Index point, std::size_t i) {
  if (!rotates(i)) return;
  const Index d = rows.dimension();
  Index index = 0, largest = 0;
  double part = 0.0;
  for (SparseRowMatrix::InnerIterator entry(*rows.rotating_trace, point); entry; ++entry, ++index) {
    if (std::abs(entry.value()) <= std::abs(part)) continue;
    part = entry.value();
    largest = index;
  }
  const auto read = [&](const SparseRowMatrix& matrix, Index row, Index direction) {
    const double* const values = matrix.valuePtr() + matrix.outerIndexPtr()[row] + largest * d;
    for (Index k = 0; k < d; ++k) directions_[i](direction, k) = values[k] / part;
  };
  read(rows.gap_operator, point, 0);
  for (Index j = 1; j < directions_[i].rows(); ++j) read(rows.tangential_trace, point * (d - 1) + j - 1, j);
}

/// Computes D v of one point, from the rows of E to those of H.
template <class From, class To>
void RotatingRows::rotate_point(std::size_t i, const From& v, To& result) const {
  const auto from = v.segment(first_[i], first_[i + 1] - first_[i]);
  auto to = result.segment(row_[i], row_[i + 1] - row_[i]);
  if (rotates(i)) {
    to = directions_[i].lazyProduct(from);
  } else {
    to = from;
  }
}

Matrix RotatingRows::product(const Matrix& k) const {
  Matrix half(k.rows(), row_.back());  // K Dᵀ, above the diagonal
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const auto from = k.block(0, first_[i], first_[i + 1], first_[i + 1] - first_[i]);
    auto to = half.block(0, row_[i], first_[i + 1], row_[i + 1] - row_[i]);
    if (rotates(i)) {
      to = from.lazyProduct(directions_[i].transpose());
    } else {
      to = from;
    }
  }
  Matrix result(row_.back(), row_.back());
  for (std::size_t j = 0; j < directions_.size(); ++j) {
    for (Index column = row_[j]; column < row_[j + 1]; ++column) {
      auto to = result.col(column);
      for (std::size_t i = 0; i <= j; ++i) rotate_point(i, half.col(column), to);
    }
  }
  result.triangularView<Eigen::StrictlyLower>() = result.transpose();
  return result;
}

void RotatingRows::rotate(const Vector& v, Vector& result) const {
  result.resize(row_.back());
  for (std::size_t i = 0; i < directions_.size(); ++i) rotate_point(i, v, result);
}

void RotatingRows::rotate_back(const Vector& r, Vector& result) const {
  result.resize(first_.back());
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const auto from = r.segment(row_[i], row_[i + 1] - row_[i]);
    auto to = result.segment(first_[i], first_[i + 1] - first_[i]);
    if (rotates(i)) {
      to = directions_[i].transpose().lazyProduct(from);
    } else {
      to = from;
    }
  }
}

}  // namespace ricochet
