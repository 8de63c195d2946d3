#include "ricochet/solver/delassus/delassus_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/log.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/linear_algebra/dense_factor.hpp"
#include "ricochet/linear_algebra/dense_kernels.hpp"

namespace ricochet {

namespace {

/// Columns stored together: few enough for their paths to be similar, enough for dense products to be fast.
constexpr Index block_size = 24;
/// Seconds between reports of progress.
constexpr double silence = 5.0;

/// Gathers the rows of a path from a vector in factor order into the first of `values`, which only grows.
void gather(const FactorPath& path, const Vector& y, Vector& values) {
  if (values.size() < path.rows()) values.resize(path.rows());
  for (std::size_t k = 0; k < path.supernodes.size(); ++k)
    std::copy_n(y.data() + path.first[k], path.offsets[k + 1] - path.offsets[k], values.data() + path.offsets[k]);
}

void scatter(const FactorPath& path, const Vector& values, Vector& y) {
  for (std::size_t k = 0; k < path.supernodes.size(); ++k)
    std::copy_n(values.data() + path.offsets[k], path.offsets[k + 1] - path.offsets[k], y.data() + path.first[k]);
}

}  // namespace

void DelassusColumns::clear() {
  blocks_.clear();
  row_count_ = 0;
}

std::size_t DelassusColumns::entries() const {
  std::size_t sum = 0;
  for (const Block& block : blocks_) sum += std::size_t(block.columns.size());
  return sum;
}

/// Computes the columns of a block from the rows `begin`… of H.
void DelassusColumns::fill(Block& block, const SparseMatrix& transposed, Index begin) const {
  const auto on_path = [&](Index row) {
    const auto& first = block.path.first;
    const auto k = std::size_t(std::ranges::upper_bound(first, row) - first.begin()) - 1;
    return block.path.offsets[k] + row - first[k];
  };
  block.columns.setZero();
  for (Index column = 0; column < block.columns.cols(); ++column) {
    for (SparseMatrix::InnerIterator entry(transposed, begin + column); entry; ++entry)
      block.columns(on_path(factor_.factor_index(entry.row())), column) = entry.value();
  }
  factor_.supernodal().forward_on_path(block.path, block.columns);
}

/// Sets the path of a block to that of all of its rows.
void DelassusColumns::find_path(Block& block, const SparseMatrix& transposed, Index begin) const {
  std::vector<Index> reached;
  for (Index row = begin; row < begin + block.columns.cols(); ++row) {
    for (SparseMatrix::InnerIterator entry(transposed, row); entry; ++entry)
      reached.push_back(factor_.factor_index(entry.row()));
  }
  block.path = factor_.supernodal().path(reached);
  block.columns.resize(block.path.rows(), block.columns.cols());
}

void DelassusColumns::append_block(const SparseMatrix& transposed, Index begin, Index end) {
  Block block;
  block.row = row_count_;
  block.columns.resize(0, end - begin);
  find_path(block, transposed, begin);
  fill(block, transposed, begin);
  row_count_ += end - begin;
  blocks_.push_back(std::move(block));
}

void DelassusColumns::renew(const SparseMatrix& transposed, const std::vector<char>& is_new, Matrix& w) {
  std::vector<char> renewed(blocks_.size(), 0);
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    Block& block = blocks_[i];
    const auto begin = is_new.begin() + block.row;
    if (std::find(begin, begin + block.columns.cols(), 1) == begin + block.columns.cols()) continue;
    find_path(block, transposed, block.row);
    fill(block, transposed, block.row);
    renewed[i] = 1;
  }
  for (std::size_t j = 0; j < blocks_.size(); ++j) {
    for (std::size_t i = 0; i <= j; ++i) {
      if (renewed[i] == 0 && renewed[j] == 0) continue;
      w.block(blocks_[i].row, blocks_[j].row, blocks_[i].columns.cols(), blocks_[j].columns.cols()).setZero();
      add_product(blocks_[i], blocks_[j], w);
    }
  }
  w.triangularView<Eigen::StrictlyLower>() = w.transpose();
}

/// Adds YᵀY of two blocks: paths meet in whole supernodes.
void DelassusColumns::add_product(const Block& left, const Block& right, Matrix& w) {
  std::size_t i = 0, j = 0;
  while (i < left.path.supernodes.size() && j < right.path.supernodes.size()) {
    if (left.path.supernodes[i] < right.path.supernodes[j]) {
      ++i;
    } else if (right.path.supernodes[j] < left.path.supernodes[i]) {
      ++j;
    } else {
      const Index rows = left.path.offsets[i + 1] - left.path.offsets[i];
      add_transposed_product(rows, left.columns.cols(), right.columns.cols(), &left.columns(left.path.offsets[i], 0),
                             left.columns.rows(), &right.columns(right.path.offsets[j], 0), right.columns.rows(),
                             &w(left.row, right.row), w.rows());
      ++i;
      ++j;
    }
  }
}

void DelassusColumns::append(const SparseMatrix& transposed, Matrix& w) {
  const std::size_t old_blocks = blocks_.size();
  const Index old_rows = row_count_;
  Timer since_report;
  for (Index begin = 0; begin < transposed.cols(); begin += block_size) {
    append_block(transposed, begin, std::min(begin + block_size, transposed.cols()));
    if (since_report.seconds() < silence) continue;
    log::info(fmt::format("condensing contact: {} of {} rows", row_count_ - old_rows, transposed.cols()));
    since_report.restart();
  }
  w.conservativeResize(row_count_, row_count_);
  w.rightCols(row_count_ - old_rows).setZero();
  w.bottomRows(row_count_ - old_rows).setZero();
  for (std::size_t j = old_blocks; j < blocks_.size(); ++j) {
    for (std::size_t i = 0; i <= j; ++i) add_product(blocks_[i], blocks_[j], w);
  }
  w.triangularView<Eigen::StrictlyLower>() = w.transpose();
}

void DelassusColumns::motion(const Vector& y, Vector& result) {
  result.resize(row_count_);
  for (const Block& block : blocks_) {
    gather(block.path, y, gathered_);
    multiply_transposed(block.columns, gathered_, result.data() + block.row);
  }
}

void DelassusColumns::add_reaction(const Vector& r, Vector& y) {
  for (const Block& block : blocks_) {
    const Index count = block.columns.cols();
    if (block.columns.rows() == 0 || r.segment(block.row, count).isZero(0.0)) continue;
    gather(block.path, y, gathered_);
    for (Index k = 0; k < count; ++k) {
      const double factor = r[block.row + k];
      if (factor == 0.0) continue;
      add_columns(block.columns.rows(), 1, &block.columns(0, k), block.columns.rows(), &factor, gathered_.data());
    }
    scatter(block.path, gathered_, y);
  }
}

}  // namespace ricochet
