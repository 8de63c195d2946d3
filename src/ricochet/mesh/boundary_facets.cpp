#include "ricochet/mesh/boundary_facets.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Vertices of a facet, ascending; leading entries are −1 if there are fewer than four.
using Key = std::array<Index, 4>;

Key key_of(const Index* cell, const std::vector<int>& local) {
  Key key{-1, -1, -1, -1};
  const std::size_t count = local.size();
  for (std::size_t k = 0; k < count; ++k) key[4 - count + k] = cell[local[k]];
  std::ranges::sort(key);
  return key;
}

Index smallest_vertex(const Key& key) {
  return *std::find_if(key.begin(), key.end(), [](Index vertex) { return vertex >= 0; });
}

bool comes_before(const CellFacet& a, const CellFacet& b) {
  return std::tie(a.block, a.cell, a.local) < std::tie(b.block, b.cell, b.local);
}

/// Calls visit(facet, key) for every facet of every cell.
template <class Visit>
void for_each_facet(const std::vector<CellBlock>& cells, const Visit& visit) {
  for (std::size_t block = 0; block < cells.size(); ++block) {
    const CellBlock& all = cells[block];
    const std::vector<std::vector<int>>& locals = facet_nodes(all.shape, 1);
    for (Index cell = 0; cell < all.size(); ++cell) {
      for (std::size_t local = 0; local < locals.size(); ++local)
        visit(CellFacet{block, cell, local}, key_of(all.cell(cell), locals[local]));
    }
  }
}

/// Calls visit(facets) for each distinct facet, with all facets of cells that have its vertices.
template <class Visit>
void for_each_distinct_facet(const std::vector<CellBlock>& cells, const Visit& visit) {
  Index nodes = 0;
  for (const CellBlock& block : cells) {
    for (const Index node : block.nodes) nodes = std::max(nodes, node + 1);
  }
  // Buckets by the smallest vertex: a table of all keys would need several times the memory.
  std::vector<std::size_t> start(static_cast<std::size_t>(nodes) + 1, 0);
  for_each_facet(cells, [&](const CellFacet&, const Key& key) { ++start[std::size_t(smallest_vertex(key)) + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<CellFacet> sorted(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for_each_facet(cells, [&](const CellFacet& facet, const Key& key) {
    sorted[next[std::size_t(smallest_vertex(key))]++] = facet;
  });

  using Entry = std::pair<Key, CellFacet>;
  std::vector<Entry> bucket;
  const auto by_key_and_cell = [](const Entry& a, const Entry& b) {
    return a.first != b.first ? a.first < b.first : comes_before(a.second, b.second);
  };
  std::vector<CellFacet> equal;
  for (std::size_t node = 0; node + 1 < start.size(); ++node) {
    bucket.clear();
    for (std::size_t i = start[node]; i < start[node + 1]; ++i) {
      const CellBlock& block = cells[sorted[i].block];
      const std::vector<int>& local = facet_nodes(block.shape, 1)[sorted[i].local];
      bucket.emplace_back(key_of(block.cell(sorted[i].cell), local), sorted[i]);
    }
    std::ranges::sort(bucket, by_key_and_cell);
    for (std::size_t i = 0; i < bucket.size();) {
      equal.clear();
      const Key& key = bucket[i].first;
      for (; i < bucket.size() && bucket[i].first == key; ++i) equal.push_back(bucket[i].second);
      visit(equal);
    }
  }
}

/// Returns whether two cells lie on opposite sides of the facet they share: they traverse it in opposite directions.
bool are_opposite(const std::vector<CellBlock>& cells, const CellFacet& one, const CellFacet& other) {
  const auto outward_vertices = [&](const CellFacet& facet) {
    const CellBlock& block = cells[facet.block];
    std::vector<Index> vertices;
    for (const int local : outward_facet_vertices(block.shape)[facet.local])
      vertices.push_back(block.cell(facet.cell)[local]);
    return vertices;
  };
  std::vector<Index> first = outward_vertices(one);
  std::vector<Index> second = outward_vertices(other);
  if (first.size() == 2) return first[0] == second[1];
  std::ranges::reverse(second);
  std::rotate(first.begin(), std::ranges::min_element(first), first.end());
  std::rotate(second.begin(), std::ranges::min_element(second), second.end());
  return first == second;
}

}  // namespace

std::vector<CellFacet> boundary_facets(const std::vector<CellBlock>& cells) {
  std::vector<CellFacet> result;
  for_each_distinct_facet(cells, [&](const std::vector<CellFacet>& equal) {
    if (equal.size() == 1) result.push_back(equal.front());
  });
  std::ranges::sort(result, comes_before);
  return result;
}

std::vector<SharedFacet> folded_facets(const std::vector<CellBlock>& cells) {
  std::vector<SharedFacet> result;
  for_each_distinct_facet(cells, [&](const std::vector<CellFacet>& equal) {
    for (std::size_t i = 0; i < equal.size(); ++i) {
      for (std::size_t j = i + 1; j < equal.size(); ++j) {
        if (!are_opposite(cells, equal[i], equal[j])) result.push_back({equal[i], equal[j]});
      }
    }
  });
  std::ranges::sort(result, [](const SharedFacet& a, const SharedFacet& b) {
    return comes_before(a.first, b.first) || (!comes_before(b.first, a.first) && comes_before(a.second, b.second));
  });
  return result;
}

std::vector<Index> nodes_of_facet(const std::vector<CellBlock>& cells, const CellFacet& facet) {
  const CellBlock& block = cells[facet.block];
  const int degree = degree_of(block.shape, block.nodes_per_cell);
  std::vector<Index> nodes;
  for (const int local : facet_nodes(block.shape, degree)[facet.local]) nodes.push_back(block.cell(facet.cell)[local]);
  return nodes;
}

}  // namespace ricochet
