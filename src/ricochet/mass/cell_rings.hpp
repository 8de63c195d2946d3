#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Rings of cells around a cell, connected through shared facets: no ring crosses a
/// slit, or passes from body to body.
namespace ricochet {

class CellMasses;

class CellRings {
 public:
  /// Number of cells around a cell after which a search ends: moving inertia from farther
  /// away multiplies it a hundredfold.
  static constexpr std::size_t many_cells = 5000;

  explicit CellRings(const CellMasses& cells, Index node_count);

  /// Begins with the cell alone.
  void start(int cell);
  /// Adds the cells that share a facet with the outermost ring, in ascending order; returns false if there are none.
  /// The cost is proportional to the number of cells added.
  bool grow();
  /// All cells so far, ring by ring.
  [[nodiscard]] const std::vector<int>& cells() const { return ring_cells_; }

  /// Nodes of all these cells, ascending and unique.
  [[nodiscard]] std::vector<Index> nodes() const;

  [[nodiscard]] const int* nodes(int cell) const { return nodes_.data() + first_node_[std::size_t(cell)]; }
  [[nodiscard]] int node_count(int cell) const {
    return first_node_[std::size_t(cell) + 1] - first_node_[std::size_t(cell)];
  }
  [[nodiscard]] int count() const { return int(first_node_.size()) - 1; }

 private:
  static constexpr int most_facets = 6;
  const int* neighbours(int cell);

  std::vector<int> first_node_{0}, nodes_;    ///< nodes per cell
  std::vector<int> first_cell_, node_cells_;  ///< cells per node
  int facet_nodes_ = 0;                       ///< least number of common nodes of two cells that share a facet
  std::vector<int> neighbours_;               ///< six per cell, −1 after the last; −2 first: not yet determined
  std::vector<int> common_;                   ///< per cell: number of nodes in common with the current cell, else 0
  std::vector<int> ring_cells_;
  std::size_t frontier_ = 0;  ///< the first cell of the outermost ring
  std::vector<int> stamp_;    ///< per cell: the last run that added it
  int run_ = 0;
};

}  // namespace ricochet
