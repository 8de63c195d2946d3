#pragma once

#include <utility>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The finite element space of the displacement: Lagrange of degree 1 or 2, d components per node.
namespace ricochet {

/// Dof of component k at node i is i·dimension + k. Nodes are numbered so that near ones have near numbers
/// (order_nodes): products and assembly then find what they need in the caches. People know them by other numbers.
struct DisplacementSpace {
  int dimension = 2;
  int degree = 1;
  Points nodes;                   ///< dimension × count, positions in the reference configuration
  std::vector<CellBlock> cells;   ///< blocks in the order of the mesh, with this space's nodes
  std::vector<CellBlock> facets;  ///< likewise
  /// For each node its number for people and files, from 0: in the order of the mesh file (of its vertices where the
  /// degree is 1), and after these the nodes that degree 2 adds to a straight mesh.
  std::vector<Index> number;
  /// Pairs of nodes of different cells that belong to one body, since one of them is tied to the other.
  std::vector<std::pair<Index, Index>> glued = {};

  /// The last nodes, which are of no cell: those of rigid bodies (rigid/free_motion.hpp).
  Index nodes_without_cells = 0;

  [[nodiscard]] Index node_count() const { return nodes.cols(); }
  [[nodiscard]] Index cell_node_count() const { return nodes.cols() - nodes_without_cells; }
  [[nodiscard]] Index dof_count() const { return nodes.cols() * dimension; }
};

/// Diagonal of the box around all nodes: a scale of rounding errors alone, as it depends on the axes of the frame by up
/// to a factor √d. Sizes that decide or are told are those of base/point_sets.hpp.
[[nodiscard]] double extent(const Points& nodes);

/// Builds the space on a mesh whose geometry is of degree 1 or 2, independently of `degree`.
[[nodiscard]] DisplacementSpace make_displacement_space(const Mesh& mesh, int degree);

/// Where a facet or a cell, numbered through all blocks, is kept.
[[nodiscard]] inline PlaceInBlocks locate_facet(const DisplacementSpace& space, Index facet) {
  return place_in_blocks(space.facets, facet);
}
[[nodiscard]] inline PlaceInBlocks locate_cell(const DisplacementSpace& space, Index cell) {
  return place_in_blocks(space.cells, cell);
}

/// The nodes of the given facets (numbered through all blocks), ascending, each once.
[[nodiscard]] std::vector<Index> facet_nodes(const DisplacementSpace& space, const std::vector<Index>& facets);

/// Node of cells nearest to a point (the lowest number for people on ties) and its distance.
struct NearestNode {
  Index node = 0;
  double distance = 0.0;
};
[[nodiscard]] NearestNode nearest_node(const DisplacementSpace& space, const Vector& point);

}  // namespace ricochet
