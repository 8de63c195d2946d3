#pragma once

#include <span>
#include <string>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/mesh/shapes/cell_shape.hpp"

/// @file The mesh: nodes, cells, boundary facets, named groups. A mesh returned by read_mesh is complete and checked.
namespace ricochet {

/// Cells (or facets) of one shape. All blocks of a mesh have the same geometric degree.
struct CellBlock {
  CellShape shape = CellShape::triangle;
  int nodes_per_cell = 0;
  std::vector<Index> nodes;        ///< count × nodes_per_cell, row by row, in Basix's order
  std::vector<std::int64_t> tags;  ///< the element's number in the file, for messages

  [[nodiscard]] Index size() const { return Index(tags.size()); }
  [[nodiscard]] const Index* cell(Index i) const { return nodes.data() + i * nodes_per_cell; }
};

/// Block and local index of a cell or facet that is numbered through all blocks.
struct IndexInBlocks {
  std::size_t block = 0;
  Index local = 0;
};
[[nodiscard]] inline IndexInBlocks locate_in_blocks(const std::vector<CellBlock>& blocks, Index number) {
  IndexInBlocks location{0, number};
  while (location.local >= blocks[location.block].size()) location.local -= blocks[location.block++].size();
  return location;
}

/// Calls visit(number, its nodes) for the elements of all blocks, numbered through them.
template <class Visit>
void each_cell(const std::vector<CellBlock>& blocks, const Visit& visit) {
  Index number = 0;
  for (const CellBlock& block : blocks) {
    for (Index i = 0; i < block.size(); ++i, ++number)
      visit(number, std::span<const Index>(block.cell(i), std::size_t(block.nodes_per_cell)));
  }
}

/// A named physical group. The name of an unnamed physical group is its number.
struct Group {
  std::string name;
  int tag = 0;
  int dimension = 0;
  /// Cells (dimension of the mesh) or facets (one less), numbered through all blocks in their order, ascending; empty
  /// for groups of lower dimension, which are kept only so that messages can name them.
  std::vector<Index> members;
};

/// Part of a mesh that comes from one of several files, see merge_parts. Parts share no nodes.
struct MeshPart {
  std::string name;
  Index first_node = 0, node_count = 0;  ///< its nodes are consecutive
  std::vector<Index> cells;              ///< numbered through all blocks, ascending

  [[nodiscard]] bool has_node(Index node) const { return node >= first_node && node < first_node + node_count; }
  /// Name of one of its groups in the whole mesh: "ball.skin".
  [[nodiscard]] std::string group_name(const std::string& group) const { return name + "." + group; }
};

struct Mesh {
  std::string source;                   ///< the file, for messages; for several files, the parts
  int dimension = 2;                    ///< of the cells and of the space, 2 or 3
  int degree = 1;                       ///< of the geometry: 1 straight, 2 second-order
  Points nodes;                         ///< dimension × count; every node belongs to a cell
  std::vector<std::int64_t> node_tags;  ///< the node's number in the file, for messages
  std::vector<CellBlock> cells;         ///< one block per shape present, in the order of the shapes
  std::vector<CellBlock> facets;        ///< facets that belong to a group, likewise; each is a facet of a cell
  std::vector<Group> groups;            ///< of every dimension
  std::vector<MeshPart> parts;          ///< of a mesh of several files, in their order; else empty
  bool is_piece = false;                ///< of a partitioned mesh: groups may be empty here

  [[nodiscard]] Index node_count() const { return nodes.cols(); }
  [[nodiscard]] Index cell_count() const;
  [[nodiscard]] Index facet_count() const;
  /// Returns the group of the given dimension, or null.
  [[nodiscard]] const Group* find_group(const std::string& name, int dimension) const;
  /// Like find_group, but throws Error(invalid_input), which says what was requested, lists the groups of that
  /// dimension, suggests the nearest name, and says so if the name exists in another dimension.
  [[nodiscard]] const Group& group(const std::string& name, int dimension) const;
};

struct CellLocation {
  Vector centre;         ///< mean of the cell's vertices, in the reference configuration
  std::int64_t tag = 0;  ///< the cell's number in the mesh file
};
/// Returns position and tag of a cell, numbered through all blocks.
[[nodiscard]] CellLocation location_of_cell(const Mesh& mesh, Index cell);

}  // namespace ricochet
