#include "ricochet/linear_algebra/node_matrix.hpp"

#include <algorithm>
#include <array>

#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/node_kernels.hpp"

namespace ricochet {

namespace {

/// True for m ⊗ I: the columns of a node's components have their own component's rows only, and the same values.
bool acts_on_components_alike(const SparseMatrix& matrix, int d) {
  const int* outer = matrix.outerIndexPtr();
  const int* inner = matrix.innerIndexPtr();
  const double* values = matrix.valuePtr();
  for (Index column = 0; column < matrix.cols(); ++column) {
    const int component = static_cast<int>(column % d);
    const Index first = column - component;
    if (outer[column + 1] - outer[column] != outer[first + 1] - outer[first]) return false;
    for (int k = outer[column], of_first = outer[first]; k < outer[column + 1]; ++k, ++of_first) {
      if (inner[k] % d != component || inner[k] - component != inner[of_first]) return false;
      if (values[k] != values[of_first]) return false;
    }
  }
  return true;
}

/// The blocks that are stored for one row after another.
class RowPattern {
 public:
  /// Looks at `columns` columns of the matrix per node: its d components, or 1 where they are alike.
  RowPattern(const SparseMatrix& matrix, int columns, int d, const NodeOrder& order)
      : matrix_(matrix), columns_(columns), d_(d), order_(order) {}

  /// Of the node at a place of the part [begin, end).
  void read(Index place, Index begin, Index end) {
    const Index node = order_.node[static_cast<std::size_t>(place)];
    nodes_.clear();
    for (int a = 0; a < columns_; ++a) {
      // The columns of a node mostly have the same rows, ascending: then nothing is added by the second.
      std::size_t known = 0;
      int last = -1;
      for (SparseMatrix::InnerIterator entry(matrix_, node * d_ + a); entry; ++entry) {
        const int other = static_cast<int>(entry.row()) / d_;
        if (other == last) continue;
        last = other;
        if (a > 0 && known < nodes_.size() && nodes_[known] == other) {
          ++known;
        } else {
          nodes_.push_back(other);
        }
      }
    }
    two_sided_.clear();
    one_sided_.clear();
    for (const int other : nodes_) {
      const int at = order_.place[static_cast<std::size_t>(other)];
      if (at < begin || at >= end || at == place) one_sided_.push_back(at);
      if (at > place && at < end) two_sided_.push_back(at);
    }
    for (std::vector<int>* places : {&two_sided_, &one_sided_}) {
      std::sort(places->begin(), places->end());
      places->erase(std::unique(places->begin(), places->end()), places->end());
    }
  }
  /// Places of the columns, ascending.
  [[nodiscard]] const std::vector<int>& two_sided() const { return two_sided_; }
  [[nodiscard]] const std::vector<int>& one_sided() const { return one_sided_; }

 private:
  const SparseMatrix& matrix_;
  int columns_, d_;
  const NodeOrder& order_;
  std::vector<int> nodes_, two_sided_, one_sided_;
};

}  // namespace

NodeMatrix::NodeMatrix(const SparseMatrix& matrix, int d, std::shared_ptr<const NodeOrder> order)
    : dimension_(d), order_(std::move(order)) {
  if (!matrix.isCompressed()) {
    SparseMatrix compressed = matrix;
    compressed.makeCompressed();
    *this = NodeMatrix(compressed, d, order_);
    return;
  }
  stride_ = acts_on_components_alike(matrix, d) ? 1 : d * d;
  read_pattern(matrix);
  read_values(matrix);
}

void NodeMatrix::read_pattern(const SparseMatrix& matrix) {
  const Index count = order_->size();
  row_begin_.assign(static_cast<std::size_t>(count) + 1, 0);
  one_sided_.assign(static_cast<std::size_t>(count), 0);
  const auto each_row = [&](const auto& enter) {
    parallel_ranges(order_->parts(), [&](Index first, Index last) {
      RowPattern row(matrix, is_scalar() ? 1 : dimension_, dimension_, *order_);
      for (auto part = static_cast<std::size_t>(first); part < static_cast<std::size_t>(last); ++part) {
        for (Index place = order_->begins[part]; place < order_->begins[part + 1]; ++place) {
          row.read(place, order_->begins[part], order_->begins[part + 1]);
          enter(static_cast<std::size_t>(place), row);
        }
      }
    });
  };
  each_row([&](std::size_t place, const RowPattern& row) {
    one_sided_[place] = static_cast<Index>(row.two_sided().size());
    row_begin_[place + 1] = static_cast<Index>(row.two_sided().size() + row.one_sided().size());
  });
  for (std::size_t place = 0; place < one_sided_.size(); ++place) {
    row_begin_[place + 1] += row_begin_[place];
    one_sided_[place] += row_begin_[place];
  }
  column_.resize(static_cast<std::size_t>(row_begin_.back()));
  each_row([&](std::size_t place, const RowPattern& row) {
    std::copy(row.two_sided().begin(), row.two_sided().end(), column_.begin() + row_begin_[place]);
    std::copy(row.one_sided().begin(), row.one_sided().end(), column_.begin() + one_sided_[place]);
  });
}

void NodeMatrix::read_values(const SparseMatrix& matrix) {
  const int d = dimension_;
  values_.assign(column_.size() * static_cast<std::size_t>(stride_), 0.0);
  parallel_ranges(order_->size(), [&](Index first, Index last) {
    for (Index place = first; place < last; ++place) {
      const Index node = order_->node[static_cast<std::size_t>(place)];
      const int* begin = column_.data() + row_begin_[static_cast<std::size_t>(place)];
      const int* middle = column_.data() + one_sided_[static_cast<std::size_t>(place)];
      const int* end = column_.data() + row_begin_[static_cast<std::size_t>(place) + 1];
      for (int a = 0; a < (is_scalar() ? 1 : d); ++a) {
        int last = -1;
        const int* at = end;
        // Columns are rows: the matrix is symmetric.
        for (SparseMatrix::InnerIterator entry(matrix, node * d + a); entry; ++entry) {
          const int other = static_cast<int>(entry.row()) / d;
          if (other != last) {
            const int other_place = order_->place[static_cast<std::size_t>(other)];
            at = std::lower_bound(begin, middle, other_place);
            if (at == middle || *at != other_place) at = std::lower_bound(middle, end, other_place);
            if (at != end && *at != other_place) at = end;
            last = other;
          }
          if (at == end) continue;
          const Index in_block = is_scalar() ? 0 : (entry.row() - Index{other} * d) * d + a;
          values_[static_cast<std::size_t>((at - column_.data()) * stride_ + in_block)] = entry.value();
        }
      }
    }
  });
}

std::size_t NodeMatrix::bytes() const {
  return sizeof(double) * values_.size() + sizeof(int) * column_.size() +
         sizeof(Index) * (row_begin_.size() + one_sided_.size());
}

void NodeMatrix::to_order(const Vector& x, Vector& ordered) const {
  const int d = dimension_;
  ordered.resize(size());
  parallel_ranges(order_->size(), [&](Index first, Index last) {
    for (Index place = first; place < last; ++place) {
      const Index node = order_->node[static_cast<std::size_t>(place)];
      for (int a = 0; a < d; ++a) ordered[place * d + a] = x[node * d + a];
    }
  });
}

void NodeMatrix::from_order(const Vector& ordered, Vector& x) const {
  const int d = dimension_;
  x.resize(size());
  parallel_ranges(order_->size(), [&](Index first, Index last) {
    for (Index node = first; node < last; ++node) {
      const Index place = order_->place[static_cast<std::size_t>(node)];
      for (int a = 0; a < d; ++a) x[node * d + a] = ordered[place * d + a];
    }
  });
}

NodeRows NodeMatrix::rows_of(Index part) const {
  const auto begin = order_->begins.begin() + part;
  return {begin[0], begin[1], row_begin_.data(), one_sided_.data(), column_.data(), values_.data()};
}

void NodeMatrix::multiply_ordered(const Vector& x, Vector& y) const {
  y.resize(size());
  parallel_ranges(order_->parts(), [&](Index first, Index last) {
    for (Index part = first; part < last; ++part) {
      multiply_rows(rows_of(part), dimension_, is_scalar(), x.data(), y.data());
    }
  });
}

double NodeMatrix::form_ordered(const Vector& x) const {
  std::array<double, NodeOrder::most_parts> sums{};
  parallel_ranges(order_->parts(), [&](Index first, Index last) {
    for (Index part = first; part < last; ++part) {
      sums[static_cast<std::size_t>(part)] = form_rows(rows_of(part), dimension_, is_scalar(), x.data());
    }
  });
  double total = 0.0;
  for (Index part = 0; part < order_->parts(); ++part) total += sums[static_cast<std::size_t>(part)];
  return total;
}

void NodeMatrix::multiply(const Vector& x, Vector& y) const {
  to_order(x, ordered_x_);
  multiply_ordered(ordered_x_, ordered_y_);
  from_order(ordered_y_, y);
}

double NodeMatrix::form(const Vector& x) const {
  to_order(x, ordered_x_);
  return form_ordered(ordered_x_);
}

/// Calls enter(place of the row, place of the column, its numbers) for every block that is stored.
template <class Enter>
void NodeMatrix::visit_blocks(const Enter& enter) const {
  for (std::size_t place = 0; place + 1 < row_begin_.size(); ++place) {
    for (Index k = row_begin_[place]; k < row_begin_[place + 1]; ++k)
      enter(static_cast<int>(place), column_[static_cast<std::size_t>(k)], values_.data() + k * stride_);
  }
}

Vector NodeMatrix::diagonal() const {
  const int d = dimension_;
  Vector result = Vector::Zero(size());
  visit_blocks([&](int row, int column, const double* block) {
    if (row != column) return;
    const Index first = Index{order_->node[static_cast<std::size_t>(row)]} * d;
    for (int a = 0; a < d; ++a) result[first + a] = block[is_scalar() ? 0 : a * d + a];
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

SparseMatrix NodeMatrix::whole() const {
  const int d = dimension_;
  const Index nodes = order_->size();
  struct Place {
    int node;
    Index block;
    bool transposed;
  };
  // Blocks per row, both sides of the diagonal.
  std::vector<Index> begins(static_cast<std::size_t>(nodes) + 1, 0);
  const auto each_block = [&](const auto& enter) {
    for (Index place = 0; place < nodes; ++place) {
      const auto row = static_cast<std::size_t>(place);
      const int node = order_->node[row];
      for (Index k = row_begin_[row]; k < row_begin_[row + 1]; ++k) {
        const int other = order_->node[static_cast<std::size_t>(column_[static_cast<std::size_t>(k)])];
        enter(node, Place{other, k, false});
        if (k < one_sided_[row]) enter(other, Place{node, k, true});
      }
    }
  };
  each_block([&](int node, const Place&) { ++begins[static_cast<std::size_t>(node) + 1]; });
  for (std::size_t i = 1; i < begins.size(); ++i) begins[i] += begins[i - 1];
  std::vector<Place> places(static_cast<std::size_t>(begins.back()));
  {
    std::vector<Index> next(begins.begin(), begins.end() - 1);
    each_block([&](int node, const Place& place) {
      places[static_cast<std::size_t>(next[static_cast<std::size_t>(node)]++)] = place;
    });
  }
  const Index per_block = is_scalar() ? 1 : d;  // entries of a block in one column of the matrix
  SparseMatrix result(size(), size());
  const Index entries = begins.back() * d * per_block;
  result.resizeNonZeros(entries);
  int* outer = result.outerIndexPtr();
  outer[size()] = static_cast<int>(entries);
  parallel_ranges(nodes, [&](Index first, Index last) {
    for (Index node = first; node < last; ++node) {
      const auto begin = places.begin() + begins[static_cast<std::size_t>(node)];
      const auto end = places.begin() + begins[static_cast<std::size_t>(node) + 1];
      std::sort(begin, end, [](const Place& a, const Place& b) { return a.node < b.node; });
      for (int a = 0; a < d; ++a) {
        Index at = (begins[static_cast<std::size_t>(node)] * d + a * (end - begin)) * per_block;
        outer[node * d + a] = static_cast<int>(at);
        for (auto place = begin; place != end; ++place) {
          const double* block = values_.data() + place->block * stride_;
          for (Index c = 0; c < per_block; ++c, ++at) {
            result.innerIndexPtr()[at] = static_cast<int>(place->node * d + (is_scalar() ? a : c));
            result.valuePtr()[at] = block[is_scalar() ? 0 : place->transposed ? a * d + c : c * d + a];
          }
        }
      }
    }
  });
  return result;
}

}  // namespace ricochet
