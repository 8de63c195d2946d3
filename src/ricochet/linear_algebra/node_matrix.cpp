#include "ricochet/linear_algebra/node_matrix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "ricochet/base/node_order.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/node_kernels.hpp"

namespace ricochet {

namespace {

/// Returns whether the matrix is m ⊗ I: the columns of a node's components have entries in rows of the same component
/// only, with the same values.
bool acts_on_components_alike(const SparseMatrix& matrix, int d) {
  const int* outer = matrix.outerIndexPtr();
  const int* inner = matrix.innerIndexPtr();
  const double* values = matrix.valuePtr();
  for (Index column = 0; column < matrix.cols(); ++column) {
    const int component = int(column % d);
    const Index first = column - component;
    if (outer[column + 1] - outer[column] != outer[first + 1] - outer[first]) return false;
    for (int k = outer[column], of_first = outer[first]; k < outer[column + 1]; ++k, ++of_first) {
      if (inner[k] % d != component || inner[k] - component != inner[of_first]) return false;
      if (values[k] != values[of_first]) return false;
    }
  }
  return true;
}

}  // namespace

NodeMatrix::NodeMatrix(const SparseMatrix& matrix, int d) : dimension_(d) {
  if (!matrix.isCompressed()) {
    SparseMatrix compressed = matrix;
    compressed.makeCompressed();
    *this = NodeMatrix(compressed, d);
    return;
  }
  stride_ = acts_on_components_alike(matrix, d) ? 1 : d * d;
  pattern_ = node_pattern(matrix, d, is_scalar());
  read_values(matrix);
}

void NodeMatrix::read_values(const SparseMatrix& matrix) {
  const int d = dimension_;
  // The kernels read one number beyond a block.
  values_.assign(pattern_.column.size() * std::size_t(stride_) + 1, 0.0);
  const int* const columns = pattern_.column.data();
  parallel_ranges(pattern_.parts(), [&](Index first, Index last) {
    pattern_.visit_rows(first, last, [&](int node, Index first_block, const RowGroup& group) {
      const int* begin = columns + first_block;
      const int* middle = begin + group.two_sided;
      const int* end = middle + group.one_sided;
      for (int a = 0; a < (is_scalar() ? 1 : d); ++a) {
        int last_other = -1;
        const int* at = end;
        // Columns equal rows, since the matrix is symmetric.
        for (SparseMatrix::InnerIterator entry(matrix, Index{node} * d + a); entry; ++entry) {
          const int other = int(entry.row()) / d;
          if (other != last_other) {
            at = std::lower_bound(begin, middle, other);
            if (at == middle || *at != other) at = std::lower_bound(middle, end, other);
            if (at != end && *at != other) at = end;
            last_other = other;
          }
          if (at == end) continue;
          const Index in_block = is_scalar() ? 0 : (entry.row() - Index{other} * d) * d + a;
          values_[std::size_t((at - columns) * stride_ + in_block)] = entry.value();
        }
      }
    });
  });
}

NodeMatrix::NodeMatrix(const std::vector<Term>& terms) : dimension_(terms.front().matrix->dimension_) {
  std::vector<const NodePattern*> patterns;
  std::vector<PatternRows> rows;
  for (const Term& term : terms) {
    patterns.push_back(&term.matrix->pattern_);
    rows.push_back(term.matrix->pattern_.rows());
    stride_ = std::max(stride_, term.matrix->stride_);
  }
  pattern_ = joined_pattern(patterns);
  values_.assign(pattern_.column.size() * std::size_t(stride_) + 1, 0.0);
  const auto add = [&](const Term& term, const PatternRow& row, Index first_block, Index count) {
    // Columns ascend in both, and those of a term are a subset of those of the sum.
    Index block = first_block;
    for (Index own = row.first_block; own < row.first_block + count; ++own, ++block) {
      const int column = term.matrix->pattern_.column[std::size_t(own)];
      while (pattern_.column[std::size_t(block)] != column) ++block;
      term.matrix->add_block(own, term.factor, stride_, values_.data() + block * stride_);
    }
  };
  parallel_ranges(pattern_.parts(), [&](Index first, Index last) {
    pattern_.visit_rows(first, last, [&](int node, Index first_block, const RowGroup& group) {
      for (std::size_t i = 0; i < terms.size(); ++i) {
        PatternRow row = rows[i][std::size_t(node)];
        add(terms[i], row, first_block, row.two_sided);
        row.first_block += row.two_sided;
        add(terms[i], row, first_block + group.two_sided, row.one_sided);
      }
    });
  });
}

/// Adds a block times a factor to a block of `stride` numbers.
void NodeMatrix::add_block(Index block, double factor, Index stride, double* sum) const {
  const double* own = values_.data() + block * stride_;
  if (stride == stride_) {
    for (Index k = 0; k < stride; ++k) sum[k] += factor * own[k];
  } else {
    for (Index k = 0; k < stride; k += dimension_ + 1) sum[k] += factor * own[0];
  }
}

std::size_t NodeMatrix::bytes() const { return sizeof(double) * values_.size() + pattern_.bytes(); }

void NodeMatrix::multiply(const Vector& x, Vector& y) const {
  y.resize(size());
  parallel_ranges(pattern_.parts(), [&](Index first, Index last) {
    for (Index part = first; part < last; ++part) {
      multiply_rows(part_rows(pattern_, part, values_.data()), dimension_, is_scalar(), x.data(), y.data());
    }
  });
}

double NodeMatrix::quadratic_form(const Vector& x) const {
  std::array<double, most_node_parts> sums{};
  parallel_ranges(pattern_.parts(), [&](Index first, Index last) {
    for (Index part = first; part < last; ++part) {
      sums[std::size_t(part)] = form_rows(part_rows(pattern_, part, values_.data()), dimension_, is_scalar(), x.data());
    }
  });
  double total = 0.0;
  for (Index part = 0; part < pattern_.parts(); ++part) total += sums[std::size_t(part)];
  return total;
}

/// Calls enter(node of the row, node of the column, its numbers) for every stored block.
template <class Enter>
void NodeMatrix::visit_blocks(const Enter& enter) const {
  pattern_.visit_rows(0, pattern_.parts(), [&](int node, Index first_block, const RowGroup& group) {
    for (Index k = first_block; k < first_block + group.blocks_per_row(); ++k)
      enter(node, pattern_.column[std::size_t(k)], values_.data() + k * stride_);
  });
}

double NodeMatrix::absolute_quadratic_form(const Vector& x) const {
  const int d = dimension_;
  double sum = 0.0;
  pattern_.visit_rows(0, pattern_.parts(), [&](int node, Index first_block, const RowGroup& group) {
    for (Index k = 0; k < group.blocks_per_row(); ++k) {
      const double* const block = values_.data() + (first_block + k) * stride_;
      const Index row = Index{node} * d;
      const Index column = Index{pattern_.column[std::size_t(first_block + k)]} * d;
      double own = 0.0;
      for (int a = 0; a < d; ++a) {
        for (int b = 0; b < d; ++b) {
          if (is_scalar() && a != b) continue;
          own += std::abs(x[row + a] * block[is_scalar() ? 0 : b * d + a] * x[column + b]);
        }
      }
      sum += k < group.two_sided ? 2.0 * own : own;
    }
  });
  return sum;
}

Vector NodeMatrix::diagonal() const {
  const int d = dimension_;
  Vector result = Vector::Zero(size());
  visit_blocks([&](int row, int column, const double* block) {
    if (row != column) return;
    const Index first = Index{row} * d;
    for (int a = 0; a < d; ++a) result[first + a] = block[is_scalar() ? 0 : a * d + a];
  });
  return result;
}

Vector NodeMatrix::diagonal_blocks() const {
  const Index d = dimension_, size_of_block = d * d;
  Vector result = Vector::Zero(size() * d);
  pattern_.visit_rows(0, pattern_.parts(), [&](int node, Index first_block, const RowGroup& group) {
    for (Index k = first_block + group.two_sided; k < first_block + group.blocks_per_row(); ++k) {
      if (pattern_.column[std::size_t(k)] == node)
        add_block(k, 1.0, size_of_block, result.data() + node * size_of_block);
    }
  });
  return result;
}

bool NodeMatrix::is_diagonal() const {
  const int d = dimension_;
  bool result = true;
  visit_blocks([&](int row, int column, const double* block) {
    for (Index k = 0; k < stride_; ++k)
      result = result && (block[k] == 0.0 || (row == column && (is_scalar() || k % (d + 1) == 0)));
  });
  return result;
}

SparseMatrix NodeMatrix::to_sparse() const {
  std::vector<Index> all(pattern_.node.size());
  std::iota(all.begin(), all.end(), Index{0});
  return principal(all);
}

namespace {

/// Position of each node in `selected`; −1 if it is not in it.
std::vector<int> positions_of(const std::vector<Index>& selected, std::size_t nodes) {
  std::vector<int> position(nodes, -1);
  for (std::size_t i = 0; i < selected.size(); ++i) position[std::size_t(selected[i])] = int(i);
  return position;
}

}  // namespace

SparseMatrix NodeMatrix::principal(const std::vector<Index>& selected) const {
  const std::vector<int> position = positions_of(selected, pattern_.node.size());
  const auto count = Index(selected.size());
  return extract(position, count, position, count);
}

SparseMatrix NodeMatrix::columns(const std::vector<Index>& selected) const {
  std::vector<int> all(pattern_.node.size());
  std::iota(all.begin(), all.end(), 0);
  return extract(all, Index(all.size()), positions_of(selected, all.size()), Index(selected.size()));
}

/// Extracts block rows and columns, numbered by `row_of` and `column_of` per node; −1 omits a node.
SparseMatrix NodeMatrix::extract(const std::vector<int>& row_of, Index rows, const std::vector<int>& column_of,
                                 Index columns) const {
  const int d = dimension_;
  struct BlockPosition {
    int row;
    Index block;
    bool transposed;
  };
  const auto each_block = [&](const auto& enter) {
    const auto enter_selected = [&](int row, int column, Index block, bool transposed) {
      if (row_of[std::size_t(row)] >= 0 && column_of[std::size_t(column)] >= 0)
        enter(column_of[std::size_t(column)], BlockPosition{row_of[std::size_t(row)], block, transposed});
    };
    // A block stored in a row belongs, transposed, to its column; a two-sided block also belongs to the other column.
    pattern_.visit_rows(0, pattern_.parts(), [&](int node, Index first_block, const RowGroup& group) {
      if (row_of[std::size_t(node)] < 0 && column_of[std::size_t(node)] < 0) return;
      for (Index k = 0; k < group.blocks_per_row(); ++k) {
        const int other = pattern_.column[std::size_t(first_block + k)];
        enter_selected(other, node, first_block + k, true);
        if (k < group.two_sided) enter_selected(node, other, first_block + k, false);
      }
    });
  };
  std::vector<Index> begins(static_cast<std::size_t>(columns) + 1, 0);  // of the blocks of each column
  each_block([&](int column, const BlockPosition&) { ++begins[std::size_t(column) + 1]; });
  for (std::size_t i = 1; i < begins.size(); ++i) begins[i] += begins[i - 1];
  std::vector<BlockPosition> positions(static_cast<std::size_t>(begins.back()));
  {
    std::vector<Index> next(begins.begin(), begins.end() - 1);
    each_block([&](int column, const BlockPosition& position) {
      positions[std::size_t(next[std::size_t(column)]++)] = position;
    });
  }
  const Index per_block = is_scalar() ? 1 : d;  // entries of a block in one column of the matrix
  SparseMatrix result(rows * d, columns * d);
  const Index entries = begins.back() * d * per_block;
  result.resizeNonZeros(entries);
  int* outer = result.outerIndexPtr();
  outer[columns * d] = int(entries);
  parallel_ranges(columns, [&](Index first, Index last) {
    for (Index column = first; column < last; ++column) {
      const auto begin = positions.begin() + begins[std::size_t(column)];
      const auto end = positions.begin() + begins[std::size_t(column) + 1];
      std::sort(begin, end, [](const BlockPosition& a, const BlockPosition& b) { return a.row < b.row; });
      for (int a = 0; a < d; ++a) {
        Index at = (begins[std::size_t(column)] * d + a * (end - begin)) * per_block;
        outer[column * d + a] = int(at);
        for (auto position = begin; position != end; ++position) {
          const double* block = values_.data() + position->block * stride_;
          for (Index c = 0; c < per_block; ++c, ++at) {
            result.innerIndexPtr()[at] = int(position->row * d + (is_scalar() ? a : c));
            result.valuePtr()[at] = block[is_scalar() ? 0 : position->transposed ? c * d + a : a * d + c];
          }
        }
      }
    }
  });
  return result;
}

}  // namespace ricochet
