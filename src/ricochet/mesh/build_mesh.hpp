#pragma once

#include <span>
#include <string>
#include <vector>

#include "ricochet/mesh/mesh.hpp"
#include "ricochet/mesh/raw_mesh.hpp"

/// @file Construction of a checked mesh from the content of a file. Private to mesh/. Every step throws
/// Error(invalid_input) with a message that names the entities concerned.
namespace ricochet::gmsh {

struct BuildOptions {
  std::string source;  ///< the file, for messages
  double scale = 1.0;
  bool bodies_may_touch = false;
  /// If the file has no physical group: makes the group "body" of all cells, a group "volume N" ("surface N" in two
  /// dimensions) of the cells on each geometric entity, if there are several, and a group "surface N" ("curve N") of
  /// the facets on each. A CAD file cannot name its parts, and many meshes have no names.
  bool name_entities = false;
};

[[nodiscard]] Mesh build_mesh(RawMesh raw, const BuildOptions& options);

/// Elements that become cells and facets; the others only name groups.
struct Selection {
  int dimension = 0;
  int degree = 0;
  std::vector<const RawElements*> cells;
  std::vector<const RawElements*> facets;
};

/// Determines dimension and degree; refuses element types that are not supported and tags that are not unique.
[[nodiscard]] Selection select_elements(const RawMesh& raw, const std::string& source);

/// Adds all physical groups, still without members, to the mesh.
void add_groups(const RawMesh& raw, const std::string& source, Mesh& mesh);

/// Index of a node by its tag in the file.
class NodeNumbering {
 public:
  NodeNumbering(std::span<const std::int64_t> tags, const std::string& source);
  /// Returns −1 if there is no such node.
  [[nodiscard]] Index find(std::int64_t tag) const {
    if (!dense_.empty()) return tag >= 0 && tag < Index(dense_.size()) ? dense_[std::size_t(tag)] : -1;
    return find_sorted(tag);
  }

 private:
  [[nodiscard]] Index find_sorted(std::int64_t tag) const;

  std::vector<Index> dense_;  ///< by tag, used if tags are nearly consecutive; else the pairs below
  std::vector<std::pair<std::int64_t, Index>> sorted_;
};

/// Makes blocks of the elements (one per shape, nodes in Basix's order as indices into the file's nodes), merges
/// elements that the file contains once per group, and fills in the members of the groups.
[[nodiscard]] std::vector<CellBlock> collect_cells(std::span<const RawElements* const> elements,
                                                   const NodeNumbering& numbering, Mesh& mesh);

/// Checks that every facet is a facet of a cell.
void check_facets(const Mesh& mesh);

/// Keeps the nodes that belong to a cell, numbered in the file's order, and sets their coordinates.
void keep_used_nodes(const RawMesh& raw, double scale, Mesh& mesh);

/// Reverses cells whose Jacobian is negative throughout, with a note that counts them: half of the programs that write
/// meshes number the nodes of a cell this way. Refuses cells that are degenerate or tangled (the Jacobian changes
/// sign), and reversed cells that overlap a neighbour: such a mesh is folded.
void orient_cells(Mesh& mesh);

/// Throws Error(invalid_input) that names the cells whose Jacobian is not positive throughout, after `what` (such as
/// "nodes were moved") has changed the nodes.
void require_positive_cells(const Mesh& mesh, const std::string& what);

/// Checks that no two nodes coincide; with `bodies_may_touch`, that no two nodes of one body do.
void check_coincident_nodes(const Mesh& mesh, bool bodies_may_touch);

}  // namespace ricochet::gmsh
