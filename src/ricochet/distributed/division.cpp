#include "ricochet/distributed/division.hpp"

#include <algorithm>

namespace ricochet {

namespace {

/// Converts pairs of node and rank to lists of ranks per node, in one array.
void build_rank_lists(std::vector<std::pair<Index, int>>& pairs, Index nodes, std::vector<std::size_t>& begin,
                      std::vector<int>& ranks) {
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  begin.assign(std::size_t(nodes) + 1, 0);
  ranks.clear();
  for (const auto& [node, rank] : pairs) {
    ++begin[std::size_t(node) + 1];
    ranks.push_back(rank);
  }
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
}

}  // namespace

Division::Division(const DisplacementSpace& space, const SemidiscreteProblem& problem, std::vector<int> rank_of_cell)
    : rank_of_cell_(std::move(rank_of_cell)) {
  const int size = rank_of_cell_.empty() ? 1 : *std::ranges::max_element(rank_of_cell_) + 1;
  more_nodes_.resize(std::size_t(size));
  {
    std::vector<std::pair<Index, int>> pairs;
    std::size_t number = 0;
    for (const CellBlock& block : space.cells) {
      for (Index cell = 0; cell < block.size(); ++cell, ++number) {
        for (int k = 0; k < block.nodes_per_cell; ++k) pairs.emplace_back(block.cell(cell)[k], rank_of_cell_[number]);
      }
    }
    build_rank_lists(pairs, space.node_count(), begin_, ranks_);
  }
  std::vector<std::vector<Index>> more(static_cast<std::size_t>(size));
  for (Index point = 0; point < problem.contact.size(); ++point) {
    const int rank = owner(problem.contact.first_own_node(point));
    rank_of_point_.push_back(rank);
    problem.contact.visit_nodes(point, [&](Index node, double) {
      if (!has(rank, node)) more[std::size_t(rank)].push_back(node);
    });
  }
  // Recovered nodal pressures sum over the points around a node: each rank adds the part of its own points.
  for (std::size_t entry = 0; entry < problem.contact.nodes.size(); ++entry) {
    const Index node = problem.contact.nodes[entry];
    problem.contact.visit_recovery(Index(entry), [&](Index point, double) {
      const int rank = rank_of_point(point);
      if (!has(rank, node)) more[std::size_t(rank)].push_back(node);
    });
  }
  add_nodes(more);
  for (auto& nodes : more) nodes.clear();
  const NodePattern& pattern = problem.mass.pattern();
  pattern.visit_rows(0, pattern.parts(), [&](int node, Index first_block, const RowGroup& group) {
    for (Index block = first_block; block < first_block + group.blocks_per_row(); ++block) {
      const int other = pattern.column[std::size_t(block)];
      if (rank_of_pair(node, other) >= 0) continue;
      more[std::size_t(owner(std::min(node, other)))].push_back(std::max(node, other));
    }
  });
  add_nodes(more);
}

bool Division::has(int rank, Index node) const {
  const std::span<const int> ranks = ranks_of(node);
  return std::ranges::binary_search(ranks, rank);
}

int Division::rank_of_pair(Index one, Index other) const {
  for (const int rank : ranks_of(one)) {
    if (has(rank, other)) return rank;
  }
  return -1;
}

std::vector<Index> Division::points_of(int rank) const {
  std::vector<Index> result;
  for (std::size_t point = 0; point < rank_of_point_.size(); ++point) {
    if (rank_of_point_[point] == rank) result.push_back(Index(point));
  }
  return result;
}

void Division::add_nodes(const std::vector<std::vector<Index>>& more) {
  if (std::ranges::all_of(more, [](const auto& nodes) { return nodes.empty(); })) return;
  const auto nodes = Index(begin_.size()) - 1;
  std::vector<std::pair<Index, int>> pairs;
  for (Index node = 0; node < nodes; ++node) {
    for (const int rank : ranks_of(node)) pairs.emplace_back(node, rank);
  }
  for (std::size_t rank = 0; rank < more.size(); ++rank) {
    for (const Index node : more[rank]) {
      pairs.emplace_back(node, int(rank));
      more_nodes_[rank].push_back(node);
    }
  }
  build_rank_lists(pairs, nodes, begin_, ranks_);
  for (auto& own : more_nodes_) {
    std::ranges::sort(own);
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
}

}  // namespace ricochet
