#include "ricochet/linear_algebra/node_pattern.hpp"

#include <algorithm>
#include <numeric>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

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

std::size_t NodePattern::bytes() const {
  return sizeof(int) * (place.size() + column.size()) + sizeof(RowGroup) * groups.size();
}

NodePattern node_pattern(const SparseMatrix& matrix, int d, bool alike, const NodeOrder& order) {
  NodePattern pattern;
  const auto nodes = static_cast<std::size_t>(order.size());
  const auto each_part = [&](const auto& enter) {
    parallel_ranges(order.parts(), [&](Index first, Index last) {
      RowPattern row(matrix, alike ? 1 : d, d, order);
      for (auto part = static_cast<std::size_t>(first); part < static_cast<std::size_t>(last); ++part) enter(part, row);
    });
  };
  struct Counts {
    Index two_sided, one_sided;
    auto operator<=>(const Counts&) const = default;
  };
  std::vector<Counts> counts(nodes);
  pattern.place.resize(nodes);
  std::iota(pattern.place.begin(), pattern.place.end(), 0);
  each_part([&](std::size_t part, RowPattern& row) {
    const Index begin = order.begins[part], end = order.begins[part + 1];
    for (Index place = begin; place < end; ++place) {
      row.read(place, begin, end);
      counts[static_cast<std::size_t>(place)] = {static_cast<Index>(row.two_sided().size()),
                                                 static_cast<Index>(row.one_sided().size())};
    }
    std::stable_sort(pattern.place.begin() + begin, pattern.place.begin() + end, [&](int a, int b) {
      return counts[static_cast<std::size_t>(a)] < counts[static_cast<std::size_t>(b)];
    });
  });
  Index blocks = 0;
  for (std::size_t part = 0; part + 1 < order.begins.size(); ++part) {
    pattern.part_groups.push_back(static_cast<Index>(pattern.groups.size()));
    for (Index row = order.begins[part]; row < order.begins[part + 1]; ++row) {
      const Counts own = counts[static_cast<std::size_t>(pattern.place[static_cast<std::size_t>(row)])];
      const bool first = row == order.begins[part];
      if (first || pattern.groups.back().two_sided != own.two_sided || pattern.groups.back().one_sided != own.one_sided)
        pattern.groups.push_back({row, 0, blocks, own.two_sided, own.one_sided});
      ++pattern.groups.back().rows;
      blocks += own.two_sided + own.one_sided;
    }
  }
  pattern.part_groups.push_back(static_cast<Index>(pattern.groups.size()));
  pattern.column.resize(static_cast<std::size_t>(blocks));
  each_part([&](std::size_t part, RowPattern& row) {
    for (Index g = pattern.part_groups[part]; g < pattern.part_groups[part + 1]; ++g) {
      const RowGroup& group = pattern.groups[static_cast<std::size_t>(g)];
      auto to = pattern.column.begin() + group.first_block;
      for (Index r = group.first_row; r < group.end_row(); ++r) {
        row.read(pattern.place[static_cast<std::size_t>(r)], order.begins[part], order.begins[part + 1]);
        to = std::copy(row.two_sided().begin(), row.two_sided().end(), to);
        to = std::copy(row.one_sided().begin(), row.one_sided().end(), to);
      }
    }
  });
  return pattern;
}

}  // namespace ricochet
