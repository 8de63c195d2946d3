#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Cells in rings around one, by the facets that they share: no ring crosses a slit, or goes from body to body.
namespace ricochet {

class CellMasses;

class CellRings {
 public:
  /// So many cells around one are enough of a search: what is further away takes inertia at the price of a hundredfold.
  static constexpr std::size_t many_cells = 5000;

  explicit CellRings(const CellMasses& cells, Index node_count);

  /// The cell alone.
  void start(int cell);
  /// Adds the cells that share a facet with those of the outermost ring, in the order of their numbers; false where
  /// there are none. Costs what it adds.
  bool grow();
  /// Ring after ring.
  [[nodiscard]] const std::vector<int>& cells() const { return ring_cells_; }

  /// Of all these cells, ascending, each once.
  [[nodiscard]] std::vector<Index> nodes() const;

  [[nodiscard]] const int* nodes(int cell) const { return nodes_.data() + first_node_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] int node_count(int cell) const {
    return first_node_[static_cast<std::size_t>(cell) + 1] - first_node_[static_cast<std::size_t>(cell)];
  }
  [[nodiscard]] int count() const { return static_cast<int>(first_node_.size()) - 1; }

 private:
  static constexpr int most_facets = 6;
  const int* neighbours(int cell);

  std::vector<int> first_node_{0}, nodes_;    ///< of each cell
  std::vector<int> first_cell_, node_cells_;  ///< of each node
  int facet_nodes_ = 0;                       ///< that two cells have in common when they share a facet, at least
  std::vector<int> neighbours_;               ///< six per cell, −1 after the last; −2 first: not looked for yet
  std::vector<int> common_;                   ///< per cell: nodes in common with the one that is looked at, else 0
  std::vector<int> ring_cells_;
  std::size_t frontier_ = 0;  ///< the first of the outermost ring
  std::vector<int> stamp_;    ///< per cell: the run that added it last
  int run_ = 0;
};

}  // namespace ricochet
