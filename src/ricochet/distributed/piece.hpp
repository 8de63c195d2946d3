#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/fem/displacement_space.hpp"

/// @file The part of a body that one rank has.
namespace ricochet {

/// Cells of a rank with their nodes and facets, and all groups, possibly empty here. Nodes and cells keep their order.
/// Nodes are those of the cells, and additional ones on request.
struct Piece {
  Mesh mesh;
  DisplacementSpace space;
  std::vector<std::int64_t> node_number;  ///< in the space of the whole body, ascending
  std::vector<Index> cell_number;         ///< in the whole mesh, ascending, through all blocks
  std::vector<Index> facet_number;        ///< likewise; a facet belongs to the rank of its first cell
};

/// `rank_of_cell` as returned by partition_cells; `more_nodes` are nodes of the space, in any order.
[[nodiscard]] Piece cut_piece(const Mesh& mesh, const DisplacementSpace& space, const std::vector<int>& rank_of_cell,
                              int rank, const std::vector<Index>& more_nodes = {});

}  // namespace ricochet
