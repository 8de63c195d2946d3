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
  const int d = dimension_;
  // Places of the nodes that share an entry with the node at a place: those that serve both sides first.
  const auto row_of = [&](Index place, Index part_end, std::vector<int>& row) {
    row.clear();
    const Index node = order_->node[static_cast<std::size_t>(place)];
    for (int a = 0; a < d; ++a) {
      int last = -1;
      for (SparseMatrix::InnerIterator entry(matrix, node * d + a); entry; ++entry) {
        const int other = static_cast<int>(entry.row()) / d;
        if (other != last) row.push_back(order_->place[static_cast<std::size_t>(other)]);
        last = other;
      }
      if (a == 0 && stride_ == 1) break;
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    return std::stable_partition(row.begin(), row.end(), [&](int other) { return other > place && other < part_end; });
  };
  const Index count = order_->size();
  row_begin_.assign(static_cast<std::size_t>(count) + 1, 0);
  one_sided_.assign(static_cast<std::size_t>(count), 0);
  const auto each_row = [&](const auto& enter) {
    parallel_ranges(order_->parts(), [&](Index first, Index last) {
      std::vector<int> row;
      for (Index part = first; part < last; ++part) {
        const Index begin = order_->begins[static_cast<std::size_t>(part)];
        const Index end = order_->begins[static_cast<std::size_t>(part) + 1];
        for (Index place = begin; place < end; ++place) {
          const auto middle = row_of(place, end, row);
          const auto kept =
              std::remove_if(middle, row.end(), [&](int other) { return other >= begin && other < place; });
          enter(static_cast<std::size_t>(place), row.begin(), middle, kept);
        }
      }
    });
  };
  each_row([&](std::size_t place, auto begin, auto middle, auto end) {
    row_begin_[place + 1] = end - begin;
    one_sided_[place] = middle - begin;
  });
  for (std::size_t place = 0; place < one_sided_.size(); ++place) {
    row_begin_[place + 1] += row_begin_[place];
    one_sided_[place] += row_begin_[place];
  }
  column_.resize(static_cast<std::size_t>(row_begin_.back()));
  each_row([&](std::size_t place, auto begin, auto, auto end) {
    std::copy(begin, end, column_.begin() + row_begin_[place]);
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
      for (int a = 0; a < (stride_ == 1 ? 1 : d); ++a) {
        // Columns are rows: the matrix is symmetric.
        for (SparseMatrix::InnerIterator entry(matrix, node * d + a); entry; ++entry) {
          const int other = order_->place[static_cast<std::size_t>(entry.row() / d)];
          const int* at = std::lower_bound(begin, middle, other);
          if (at == middle || *at != other) at = std::lower_bound(middle, end, other);
          if (at == end || *at != other) continue;
          const Index block = at - column_.data();
          const Index in_block = stride_ == 1 ? 0 : (entry.row() % d) * d + a;
          values_[static_cast<std::size_t>(block * stride_ + in_block)] = entry.value();
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

void NodeMatrix::multiply_ordered(const Vector& x, Vector& y) const {
  y.resize(size());
  parallel_ranges(order_->parts(), [&](Index first, Index last) {
    for (Index part = first; part < last; ++part) {
      multiply_rows({order_->begins[static_cast<std::size_t>(part)], order_->begins[static_cast<std::size_t>(part) + 1],
                     row_begin_.data(), one_sided_.data(), column_.data(), values_.data()},
                    dimension_, is_scalar(), x.data(), y.data());
    }
  });
}

double NodeMatrix::form_ordered(const Vector& x) const {
  std::array<double, 64> sums{};
  parallel_ranges(order_->parts(), [&](Index first, Index last) {
    for (Index part = first; part < last; ++part) {
      sums[static_cast<std::size_t>(part)] =
          form_rows({order_->begins[static_cast<std::size_t>(part)], order_->begins[static_cast<std::size_t>(part) + 1],
                     row_begin_.data(), one_sided_.data(), column_.data(), values_.data()},
                    dimension_, is_scalar(), x.data());
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
