#include "ricochet/mesh/boundary_facets.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// The vertices of a facet, ascending; the first of four is −1 where there are fewer.
using Key = std::array<Index, 4>;

Key key_of(const Index* cell, CellShape shape, const std::vector<int>& local) {
  Key key{-1, -1, -1, -1};
  const auto count = static_cast<std::size_t>(vertex_count(facet_shape(shape)));
  for (std::size_t k = 0; k < count; ++k) key[4 - count + k] = cell[local[k]];
  std::sort(key.begin(), key.end());
  return key;
}

Index smallest_vertex(const Key& key) {
  return *std::find_if(key.begin(), key.end(), [](Index vertex) { return vertex >= 0; });
}

/// Calls visit(facet, key) for every facet of every cell.
template <class Visit>
void for_each_facet(const std::vector<CellBlock>& cells, const Visit& visit) {
  for (std::size_t block = 0; block < cells.size(); ++block) {
    const CellBlock& all = cells[block];
    const std::vector<std::vector<int>>& locals = facet_nodes(all.shape, 1);
    for (Index cell = 0; cell < all.size(); ++cell) {
      for (std::size_t local = 0; local < locals.size(); ++local)
        visit(CellFacet{block, cell, local}, key_of(all.cell(cell), all.shape, locals[local]));
    }
  }
}

}  // namespace

std::vector<CellFacet> boundary_facets(const std::vector<CellBlock>& cells) {
  Index nodes = 0;
  for (const CellBlock& block : cells) {
    for (const Index node : block.nodes) nodes = std::max(nodes, node + 1);
  }
  // In buckets by their smallest vertex: a table of all keys would take several times the memory.
  std::vector<std::size_t> start(static_cast<std::size_t>(nodes) + 1, 0);
  for_each_facet(
      cells, [&](const CellFacet&, const Key& key) { ++start[static_cast<std::size_t>(smallest_vertex(key)) + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<CellFacet> sorted(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for_each_facet(cells, [&](const CellFacet& facet, const Key& key) {
    sorted[next[static_cast<std::size_t>(smallest_vertex(key))]++] = facet;
  });

  std::vector<CellFacet> result;
  std::vector<std::pair<Key, CellFacet>> bucket;
  const auto by_key = [](const auto& a, const auto& b) { return a.first < b.first; };
  for (std::size_t node = 0; node + 1 < start.size(); ++node) {
    bucket.clear();
    for (std::size_t i = start[node]; i < start[node + 1]; ++i) {
      const CellBlock& block = cells[sorted[i].block];
      const std::vector<int>& local = facet_nodes(block.shape, 1)[sorted[i].local];
      bucket.emplace_back(key_of(block.cell(sorted[i].cell), block.shape, local), sorted[i]);
    }
    std::sort(bucket.begin(), bucket.end(), by_key);
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      const bool shared = (i > 0 && bucket[i - 1].first == bucket[i].first) ||
                          (i + 1 < bucket.size() && bucket[i + 1].first == bucket[i].first);
      if (!shared) result.push_back(bucket[i].second);
    }
  }
  std::sort(result.begin(), result.end(), [](const CellFacet& a, const CellFacet& b) {
    return std::tie(a.block, a.cell, a.local) < std::tie(b.block, b.cell, b.local);
  });
  return result;
}

std::vector<Index> nodes_of_facet(const std::vector<CellBlock>& cells, const CellFacet& facet) {
  const CellBlock& block = cells[facet.block];
  const int degree = block.nodes_per_cell == vertex_count(block.shape) ? 1 : 2;
  std::vector<Index> nodes;
  for (const int local : facet_nodes(block.shape, degree)[facet.local]) nodes.push_back(block.cell(facet.cell)[local]);
  return nodes;
}

}  // namespace ricochet
