#include "ricochet/linear_algebra/node_pattern.hpp"

#include <algorithm>
#include <numeric>

#include "ricochet/base/node_order.hpp"
#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

/// Reader of the blocks to be stored for a row of a matrix.
class RowOfMatrix {
 public:
  /// Reads `columns` columns of the matrix per node: its d components, or 1 if they are alike.
  RowOfMatrix(const SparseMatrix& matrix, int columns, int d) : matrix_(matrix), columns_(columns), d_(d) {}

  /// Reads the row of a node of the part [begin, end).
  void read(Index node, Index begin, Index end) {
    nodes_.clear();
    for (int a = 0; a < columns_; ++a) {
      // The columns of a node mostly have the same rows, ascending; the second one then adds nothing.
      std::size_t matched = 0;
      int last = -1;
      for (SparseMatrix::InnerIterator entry(matrix_, node * d_ + a); entry; ++entry) {
        const int other = int(entry.row()) / d_;
        if (other == last) continue;
        last = other;
        if (a > 0 && matched < nodes_.size() && nodes_[matched] == other) {
          ++matched;
        } else {
          nodes_.push_back(other);
        }
      }
    }
    two_sided_.clear();
    one_sided_.clear();
    for (const int other : nodes_) {
      if (other < begin || other >= end || other == node) one_sided_.push_back(other);
      if (other > node && other < end) two_sided_.push_back(other);
    }
    for (std::vector<int>* columns : {&two_sided_, &one_sided_}) {
      std::ranges::sort(*columns);
      columns->erase(std::unique(columns->begin(), columns->end()), columns->end());
    }
  }
  /// Nodes of the columns, ascending.
  [[nodiscard]] const std::vector<int>& two_sided() const { return two_sided_; }
  [[nodiscard]] const std::vector<int>& one_sided() const { return one_sided_; }

 private:
  const SparseMatrix& matrix_;
  int columns_, d_;
  std::vector<int> nodes_, two_sided_, one_sided_;
};

/// Reader of the union of the blocks that several patterns of the same nodes have in a row.
class RowOfPatterns {
 public:
  RowOfPatterns(const std::vector<const NodePattern*>& patterns, const std::vector<PatternRows>& rows)
      : patterns_(patterns), rows_(rows) {}

  void read(Index node, Index /*begin*/, Index /*end*/) {
    two_sided_.clear();
    one_sided_.clear();
    for (std::size_t i = 0; i < patterns_.size(); ++i) {
      const PatternRow row = rows_[i][std::size_t(node)];
      const auto first = patterns_[i]->column.begin() + row.first_block;
      join(first, first + row.two_sided, two_sided_);
      join(first + row.two_sided, first + row.two_sided + row.one_sided, one_sided_);
    }
  }
  [[nodiscard]] const std::vector<int>& two_sided() const { return two_sided_; }
  [[nodiscard]] const std::vector<int>& one_sided() const { return one_sided_; }

 private:
  using Iterator = LargeVector<int>::const_iterator;
  void join(Iterator begin, Iterator end, std::vector<int>& columns) {
    joined_.clear();
    std::set_union(columns.begin(), columns.end(), begin, end, std::back_inserter(joined_));
    columns.swap(joined_);
  }

  const std::vector<const NodePattern*>& patterns_;
  const std::vector<PatternRows>& rows_;
  std::vector<int> two_sided_, one_sided_, joined_;
};

/// Numbers of blocks of one row.
struct Counts {
  Index two_sided = 0, one_sided = 0;
  auto operator<=>(const Counts&) const = default;
};

/// Fills groups and part_groups from the rows and the numbers of blocks of each node; returns the total number of
/// blocks.
Index group_rows(const std::vector<Counts>& counts, NodePattern& pattern) {
  Index blocks = 0;
  for (std::size_t part = 0; part + 1 < pattern.part_begins.size(); ++part) {
    const Index begin = pattern.part_begins[part], end = pattern.part_begins[part + 1];
    for (Index row = begin; row < end; ++row) {
      const Counts own = counts[std::size_t(pattern.node[std::size_t(row)])];
      const bool same = row > begin && own == Counts{pattern.groups.back().two_sided, pattern.groups.back().one_sided};
      if (!same) pattern.groups.push_back({row, 0, blocks, own.two_sided, own.one_sided});
      ++pattern.groups.back().rows;
      blocks += own.two_sided + own.one_sided;
    }
    pattern.part_groups.push_back(Index(pattern.groups.size()));
  }
  return blocks;
}

/// `first_reader` reads rows; each thread works on a copy of it.
template <class Reader>
NodePattern pattern_of_rows(Index node_count, const Reader& first_reader) {
  NodePattern pattern;
  pattern.part_begins = node_parts(node_count);
  const std::vector<Index>& begins = pattern.part_begins;
  const auto nodes = std::size_t(begins.back());
  const auto each_part = [&](const auto& enter) {
    parallel_ranges(pattern.parts(), [&](Index first, Index last) {
      Reader row = first_reader;
      for (auto part = std::size_t(first); part < std::size_t(last); ++part) enter(part, row);
    });
  };
  std::vector<Counts> counts(nodes);
  pattern.node.resize(nodes);
  std::iota(pattern.node.begin(), pattern.node.end(), 0);
  each_part([&](std::size_t part, Reader& row) {
    const Index begin = begins[part], end = begins[part + 1];
    for (Index node = begin; node < end; ++node) {
      row.read(node, begin, end);
      counts[std::size_t(node)] = {Index(row.two_sided().size()), Index(row.one_sided().size())};
    }
    std::stable_sort(pattern.node.begin() + begin, pattern.node.begin() + end,
                     [&](int a, int b) { return counts[std::size_t(a)] < counts[std::size_t(b)]; });
  });
  pattern.column.resize(std::size_t(group_rows(counts, pattern)));
  each_part([&](std::size_t part, Reader& row) {
    for (Index g = pattern.part_groups[part]; g < pattern.part_groups[part + 1]; ++g) {
      const RowGroup& group = pattern.groups[std::size_t(g)];
      auto to = pattern.column.begin() + group.first_block;
      for (Index r = group.first_row; r < group.end_row(); ++r) {
        row.read(pattern.node[std::size_t(r)], begins[part], begins[part + 1]);
        to = std::copy(row.two_sided().begin(), row.two_sided().end(), to);
        to = std::copy(row.one_sided().begin(), row.one_sided().end(), to);
      }
    }
  });
  return pattern;
}

}  // namespace

std::size_t NodePattern::bytes() const {
  return sizeof(int) * (node.size() + column.size()) + sizeof(RowGroup) * groups.size();
}

PatternRows NodePattern::rows() const {
  PatternRows result(node.size());
  visit_rows(0, parts(), [&](int of_row, Index first_block, const RowGroup& group) {
    result[std::size_t(of_row)] = {first_block, group.two_sided, group.one_sided};
  });
  return result;
}

NodePattern node_pattern(const SparseMatrix& matrix, int d, bool alike) {
  return pattern_of_rows(matrix.cols() / d, RowOfMatrix(matrix, alike ? 1 : d, d));
}

NodePattern joined_pattern(const std::vector<const NodePattern*>& patterns) {
  std::vector<PatternRows> rows;
  for (const NodePattern* pattern : patterns) rows.push_back(pattern->rows());
  return pattern_of_rows(Index(patterns.front()->node.size()), RowOfPatterns(patterns, rows));
}

}  // namespace ricochet
