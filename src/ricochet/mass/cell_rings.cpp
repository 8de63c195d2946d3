#include "ricochet/mass/cell_rings.hpp"

#include <algorithm>

#include "ricochet/fem/cell_masses.hpp"

namespace ricochet {

CellRings::CellRings(const CellMasses& cells, Index node_count)
    : first_cell_(std::size_t(node_count) + 1, 0), facet_nodes_(cells.least_facet_nodes()) {
  cells.for_each_cell([&](const std::vector<Index>& nodes) {
    for (const Index node : nodes) {
      nodes_.push_back(int(node));
      ++first_cell_[std::size_t(node) + 1];
    }
    first_node_.push_back(int(nodes_.size()));
  });
  for (std::size_t node = 1; node < first_cell_.size(); ++node) first_cell_[node] += first_cell_[node - 1];
  node_cells_.resize(nodes_.size());
  std::vector<int> filled(first_cell_.begin(), first_cell_.end() - 1);
  for (int cell = 0; cell < count(); ++cell) {
    for (int k = 0; k < this->node_count(cell); ++k)
      node_cells_[std::size_t(filled[std::size_t(nodes(cell)[k])]++)] = cell;
  }
  const auto cell_count = std::size_t(count());
  neighbours_.assign(most_facets * cell_count, -2);
  common_.assign(cell_count, 0);
  stamp_.assign(cell_count, 0);
}

void CellRings::start(int cell) {
  ++run_;
  ring_cells_.assign(1, cell);
  stamp_[std::size_t(cell)] = run_;
  frontier_ = 0;
}

bool CellRings::grow() {
  const std::size_t before = ring_cells_.size();
  for (; frontier_ < before; ++frontier_) {
    const int* const found = neighbours(ring_cells_[frontier_]);
    for (int k = 0; k < most_facets && found[k] >= 0; ++k) {
      int& stamp = stamp_[std::size_t(found[k])];
      if (stamp == run_) continue;
      stamp = run_;
      ring_cells_.push_back(found[k]);
    }
  }
  std::sort(ring_cells_.begin() + std::ptrdiff_t(before), ring_cells_.end());
  return ring_cells_.size() > before;
}

std::vector<Index> CellRings::nodes() const {
  std::vector<Index> result;
  for (const int cell : ring_cells_) result.insert(result.end(), nodes(cell), nodes(cell) + node_count(cell));
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

const int* CellRings::neighbours(int cell) {
  int* const result = neighbours_.data() + most_facets * std::size_t(cell);
  if (result[0] != -2) return result;
  std::fill(result, result + most_facets, -1);
  int found = 0;
  const auto for_each_touching = [&](auto&& visit) {
    for (int k = 0; k < node_count(cell); ++k) {
      const auto node = std::size_t(nodes(cell)[k]);
      for (int at = first_cell_[node]; at < first_cell_[node + 1]; ++at) visit(node_cells_[std::size_t(at)]);
    }
  };
  for_each_touching([&](int other) {
    int& common = common_[std::size_t(other)];
    if (++common == facet_nodes_ && other != cell && found < most_facets) result[found++] = other;
  });
  for_each_touching([&](int other) { common_[std::size_t(other)] = 0; });
  return result;
}

}  // namespace ricochet
