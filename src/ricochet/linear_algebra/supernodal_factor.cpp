#include "ricochet/linear_algebra/supernodal_factor.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <numeric>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/supernodal_kernels.hpp"
#include "ricochet/linear_algebra/supernode_layout.hpp"
#include "ricochet/linear_algebra/wide_supernode.hpp"

namespace ricochet {

/// Factors with fewer numbers are not divided: handing work to another thread would take longer than the solve.
constexpr double least_divided_size = 1 << 18;
/// Subtrees hold at most this fraction of the factor.
constexpr double parts_per_factor = 16.0;

constexpr std::size_t huge_page = std::size_t{1} << 21;
constexpr std::size_t cache_line = 64;

HugePageBuffer::HugePageBuffer(std::size_t size) : size_(size) {
  const std::size_t alignment = size * sizeof(double) >= huge_page ? huge_page : cache_line;
  const std::size_t bytes = (size * sizeof(double) / alignment + 1) * alignment;
  values_.reset(static_cast<double*>(std::aligned_alloc(alignment, bytes)));
  if (!values_) throw std::bad_alloc();
#if defined(__linux__)
  // Only a hint: without such pages the solves are a little slower.
  if (alignment == huge_page) static_cast<void>(madvise(values_.get(), bytes, MADV_HUGEPAGE));
#endif
}

void HugePageBuffer::Release::operator()(double* values) const { std::free(values); }

SupernodalFactor::SupernodalFactor(const SupernodalStructure& shape) {
  read_shape(shape);
  partition();
  allocate_numbers(shape);
}

void SupernodalFactor::read_shape(const SupernodalStructure& shape) {
  const auto count = std::size_t(shape.supernodes);
  size_ = shape.supernodes == 0 ? 0 : shape.first_column[shape.supernodes];
  supernodes_.resize(count);
  std::vector<int> supernode_of_column(static_cast<std::size_t>(size_));
  for (std::size_t s = 0; s < count; ++s) {
    Supernode& node = supernodes_[s];
    node.first = shape.first_column[s];
    node.columns = shape.first_column[s + 1] - node.first;
    node.below = shape.row_start[s + 1] - shape.row_start[s] - node.columns;
    node.number = int(s);
    std::fill_n(supernode_of_column.begin() + node.first, node.columns, node.number);
  }
  parent_.resize(count);
  for (std::size_t s = 0; s < count; ++s) {
    const Supernode& node = supernodes_[s];
    const int* below = shape.rows + shape.row_start[s] + node.columns;
    parent_[s] = node.below == 0 ? -1 : supernode_of_column[std::size_t(*below)];
  }
}

std::vector<int> SupernodalFactor::subtrees(std::vector<double> weights, double most) const {
  const std::size_t count = supernodes_.size();
  std::vector<Index> descendants(count, 0);
  std::vector<int> first(count), root(count, -1);
  std::iota(first.begin(), first.end(), 0);
  for (std::size_t s = 0; s < count; ++s) {
    descendants[s] += 1;
    if (parent_[s] < 0) continue;
    const auto parent = std::size_t(parent_[s]);
    weights[parent] += weights[s];
    descendants[parent] += descendants[s];
    first[parent] = std::min(first[parent], first[s]);
  }
  for (std::size_t s = count; s-- > 0;) {
    const bool side_by_side = Index(s) - first[s] + 1 == descendants[s];
    if (parent_[s] >= 0 && root[std::size_t(parent_[s])] >= 0) {
      root[s] = root[std::size_t(parent_[s])];
    } else if (side_by_side && weights[s] <= most) {
      root[s] = int(s);
    }
  }
  return root;
}

/// Divides the supernodes into parts. The division fixes the order of sums; it depends on the factor alone, and must
/// not depend on the number of threads.
void SupernodalFactor::partition() {
  const std::size_t count = supernodes_.size();
  std::vector<double> sizes(count);
  double total = 0.0;
  for (std::size_t s = 0; s < count; ++s) {
    const Supernode& node = supernodes_[s];
    sizes[s] = double(SupernodeLayout(node.columns, node.columns + node.below).size());
    total += sizes[s];
  }
  const std::vector<int> part = subtrees(sizes, total < least_divided_size ? -1.0 : total / parts_per_factor);
  std::vector<Supernode> ordered;
  ordered.reserve(count);
  for (std::size_t s = 0; s < count; ++s) {
    if (part[s] < 0) continue;
    if (parts_.empty() || part[s] != part[s - 1]) parts_.push_back({ordered.size(), ordered.size(), {}, 0, {}});
    ordered.push_back(supernodes_[s]);
    parts_.back().end = ordered.size();
  }
  parts_.push_back({ordered.size(), count, {}, 0, {}});
  for (std::size_t s = 0; s < count; ++s) {
    if (part[s] < 0) ordered.push_back(supernodes_[s]);
  }
  supernodes_ = std::move(ordered);
  position_.resize(count);
  for (std::size_t k = 0; k < count; ++k) position_[std::size_t(supernodes_[k].number)] = int(k);
}

void SupernodalFactor::allocate_numbers(const SupernodalStructure& shape) {
  Index stream_size = 0, row_count = 0;
  for (Supernode& node : supernodes_) {
    node.stream = stream_size;
    node.rows = row_count;
    stream_size += SupernodeLayout(node.columns, node.columns + node.below).size();
    node.stream_end = stream_size;
    row_count += node.below;
  }
  stream_ = HugePageBuffer(std::size_t(stream_size));
  rows_.resize(std::size_t(row_count));
  for (const Supernode& node : supernodes_) {
    const int* below = shape.rows + shape.row_start[node.number] + node.columns;
    std::copy_n(below, node.below, rows_.begin() + node.rows);
  }
  work_size_ = size_;
  row_of_work_.clear();
  for (Part& part : parts_) number_boundary(part);
  const auto shared = [&](const Supernode& node) { return is_shared(parts_.back(), node); };
  if (std::any_of(supernodes_.begin() + std::ptrdiff_t(parts_.back().begin), supernodes_.end(), shared))
    sums_.resize(std::size_t(WideSupernode::sums_size()));
}

/// Replaces rows beyond a part's own columns by indices in the work space of y.
void SupernodalFactor::number_boundary(Part& part) {
  Index max_rows = 0;
  for (std::size_t k = part.begin; k < part.end; ++k)
    max_rows = std::max<Index>(max_rows, supernodes_[k].columns + supernodes_[k].below);
  part.work.assign(std::size_t(max_rows) + 1, 0.0);
  part.boundary_start = work_size_;
  if (&part == &parts_.back()) return;
  // The rows of a descendant beyond the root are among those of the root.
  const Supernode& root = supernodes_[part.end - 1];
  part.boundary.assign(rows_.begin() + root.rows, rows_.begin() + root.rows + root.below);
  const int beyond = root.first + root.columns;
  for (Index k = supernodes_[part.begin].rows; k < root.rows + root.below; ++k) {
    int& row = rows_[std::size_t(k)];
    if (row < beyond) continue;
    const auto at = std::ranges::lower_bound(part.boundary, row) - part.boundary.begin();
    row = int(part.boundary_start + at);
  }
  row_of_work_.insert(row_of_work_.end(), part.boundary.begin(), part.boundary.end());
  work_size_ += Index(part.boundary.size());
}

std::size_t SupernodalFactor::bytes() const {
  return stream_.size() * sizeof(double) + rows_.size() * sizeof(int) + supernodes_.size() * sizeof(Supernode);
}

/// Sets w to the entries of y at a supernode's columns and rows below, followed by a zero, which kernels may read.
void SupernodalFactor::gather(const Supernode& node, const double* y, double* w) const {
  const int* rows = rows_.data() + node.rows;
  std::copy_n(y + node.first, node.columns, w);
  double* const below = w + node.columns;
  for (int i = 0; i < node.below; ++i) below[i] = y[rows[i]];
  below[node.below] = 0.0;
}

/// Only the last part, processed when the subtrees are done, has all threads available.
bool SupernodalFactor::is_shared(const Part& part, const Supernode& node) const {
  return &part == &parts_.back() && WideSupernode::is_wide(node.columns, node.columns + node.below);
}

void SupernodalFactor::forward(const Part& part, double* y) const {
  double* const w = part.work.data();
  std::fill_n(y + part.boundary_start, part.boundary.size(), 0.0);
  for (std::size_t k = part.begin; k < part.end; ++k) {
    const Supernode& node = supernodes_[k];
    const Index size = node.columns + node.below;
    gather(node, y, w);
    if (is_shared(part, node)) {
      WideSupernode(node.columns, size, stream_.data() + node.stream).forward(w);
    } else {
      supernode_forward(stream_.data() + node.stream, node.columns, size, w);
    }
    std::copy_n(w, node.columns, y + node.first);
    const int* rows = rows_.data() + node.rows;
    for (int i = 0; i < node.below; ++i) y[rows[i]] = w[node.columns + i];
  }
}

void SupernodalFactor::backward(const Part& part, double* y) const {
  double* const w = part.work.data();
  for (std::size_t i = 0; i < part.boundary.size(); ++i) y[part.boundary_start + Index(i)] = y[part.boundary[i]];
  for (std::size_t k = part.end; k-- > part.begin;) {
    const Supernode& node = supernodes_[k];
    const Index size = node.columns + node.below;
    gather(node, y, w);
    if (is_shared(part, node)) {
      WideSupernode(node.columns, size, stream_.data() + node.stream).backward(w, sums_.data());
    } else {
      supernode_backward(stream_.data() + node.stream_end, node.columns, size, w);
    }
    std::copy_n(w, node.columns, y + node.first);
  }
}

void SupernodalFactor::forward(Vector& y) const {
  if (size_ == 0) return;
  const auto subtrees = Index(parts_.size()) - 1;
  parallel_ranges(subtrees, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) forward(parts_[std::size_t(k)], y.data());
  });
  for (Index k = 0; k < subtrees; ++k) {
    const Part& part = parts_[std::size_t(k)];
    for (std::size_t i = 0; i < part.boundary.size(); ++i) y[part.boundary[i]] += y[part.boundary_start + Index(i)];
  }
  forward(parts_.back(), y.data());
}

void SupernodalFactor::backward(Vector& y) const {
  if (size_ == 0) return;
  backward(parts_.back(), y.data());
  parallel_ranges(Index(parts_.size()) - 1, [&](Index begin, Index end) {
    for (Index k = end; k-- > begin;) backward(parts_[std::size_t(k)], y.data());
  });
}

FactorPath SupernodalFactor::path(const std::vector<Index>& rows) const {
  std::vector<char> reached(supernodes_.size(), 0);
  const auto first_beyond = [&](Index row) {
    // Columns ascend with the supernode's number.
    return std::partition_point(position_.begin(), position_.end(),
                                [&](int index) { return supernodes_[std::size_t(index)].first <= row; });
  };
  for (const Index row : rows) {
    auto s = int(first_beyond(row) - position_.begin()) - 1;
    for (; s >= 0 && reached[std::size_t(s)] == 0; s = parent_[std::size_t(s)]) reached[std::size_t(s)] = 1;
  }
  FactorPath path;
  path.offsets.push_back(0);
  for (std::size_t s = 0; s < reached.size(); ++s) {
    if (reached[s] == 0) continue;
    const Supernode& node = supernodes_[std::size_t(position_[s])];
    path.supernodes.push_back(int(s));
    path.first.push_back(node.first);
    path.offsets.push_back(path.offsets.back() + node.columns);
  }
  return path;
}

void SupernodalFactor::forward_on_path(const FactorPath& path, Matrix& columns) const {
  std::vector<int> position(static_cast<std::size_t>(size_), -1);
  for (std::size_t k = 0; k < path.supernodes.size(); ++k) {
    for (Index i = path.offsets[k]; i < path.offsets[k + 1]; ++i)
      position[std::size_t(path.first[k] + i - path.offsets[k])] = int(i);
  }
  const auto path_index = [&](int row) {
    const int in_factor = row < size_ ? row : row_of_work_[std::size_t(row - size_)];
    return position[std::size_t(in_factor)];
  };
  // Eight columns side by side.
  using Rows = Eigen::Matrix<double, 8, Eigen::Dynamic>;
  Rows eight(8, path.rows()), w;
  for (Index first = 0; first < columns.cols(); first += 8) {
    const Index count = std::min<Index>(8, columns.cols() - first);
    eight.setZero();
    eight.topRows(count) = columns.middleCols(first, count).transpose();
    for (std::size_t k = 0; k < path.supernodes.size(); ++k) {
      const Supernode& node = supernodes_[std::size_t(position_[std::size_t(path.supernodes[k])])];
      const int* rows = rows_.data() + node.rows;
      w.setZero(8, node.columns + node.below + 1);
      w.leftCols(node.columns) = eight.middleCols(path.offsets[k], node.columns);
      for (int i = 0; i < node.below; ++i) w.col(node.columns + i) = eight.col(path_index(rows[i]));
      supernode_forward_eight(stream_.data() + node.stream, node.columns, node.columns + node.below, w.data());
      eight.middleCols(path.offsets[k], node.columns) = w.leftCols(node.columns);
      for (int i = 0; i < node.below; ++i) eight.col(path_index(rows[i])) = w.col(node.columns + i);
    }
    columns.middleCols(first, count) = eight.topRows(count).transpose();
  }
}

}  // namespace ricochet
