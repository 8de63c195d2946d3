#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Packs of cells, processed in SIMD loops with one lane per cell, and the assembly of their nodal forces. Not
/// part of the public interface.
///
/// The parts are those of the graph: a cell belongs to the part of most of its nodes. (Without a graph, parts are runs
/// of cells.) Each part works on its own numbers, stored contiguously for all nodes of its cells; contributions to
/// nodes of another part are added when all parts are complete, in the order of the parts. Every cell is thus computed
/// once, and the result is bitwise the same for any number of threads.
namespace ricochet {

/// Numbers per node in memory: the components of a vector, padded with a zero in 3D, for packs of two or four.
template <int d>
inline constexpr int node_stride = d == 2 ? 2 : 4;

/// Consecutive packs of one part, block and material.
struct PackRun {
  std::size_t block = 0;
  int material = 0;
  Index begin = 0, end = 0;  ///< packs of the block
};

class CellPacks {
 public:
  /// Packs the given cells, ascending; all if empty. Keeps no references.
  CellPacks(const Body& body, const NodeGraph* graph, const std::vector<int>& cells);

  [[nodiscard]] Index parts() const { return Index(runs_.size()); }
  [[nodiscard]] const std::vector<PackRun>& runs(Index part) const { return runs_[std::size_t(part)]; }
  /// Cells of a block (numbered within it) in all lanes, pack by pack; −1 for unused lanes.
  [[nodiscard]] const std::vector<int>& lanes(std::size_t block) const { return lanes_[block]; }
  /// Index, among the numbers of the part, of a node of a lane: for each pack and node of the cell, one per lane. For
  /// an unused lane all its nodes are a dummy node, which belongs to no cell.
  [[nodiscard]] const std::vector<int>& slots(std::size_t block) const { return slots_[block]; }

  /// Storage for the numbers of all parts, zero.
  template <int d>
  [[nodiscard]] std::vector<double> storage() const {
    return std::vector<double>(nodes_.size() * node_stride<d>, 0.0);
  }
  /// Index of the first number of a part in that storage.
  template <int d>
  [[nodiscard]] Index begin(Index part) const {
    return begins_[std::size_t(part)] * node_stride<d>;
  }
  /// Copies a vector per dof to the numbers of a part.
  template <int d>
  void read(Index part, const Vector& from, std::vector<double>& room) const;
  /// Sets the numbers of a part to zero.
  template <int d>
  void clear(Index part, std::vector<double>& room) const;
  /// Sums the numbers of all parts into a vector per dof.
  template <int d>
  void add_up(const std::vector<double>& room, Vector& result) const;

 private:
  struct Import {
    int node;  ///< of the body
    int slot;
  };
  void share_out(const Body& body, const NodeGraph* graph, const std::vector<int>& cells);
  void number_nodes(const Body& body, const NodeGraph* graph);

  Index node_count_ = 0;
  std::vector<std::vector<PackRun>> runs_;       ///< per part
  std::vector<std::vector<int>> lanes_, slots_;  ///< per block
  std::vector<Index> begins_;                    ///< per part, and the end
  std::vector<int> nodes_;                       ///< node per index; −1: the dummy node of a part
  std::vector<Index> own_;                       ///< per part: number of its nodes that belong to the part itself
  std::vector<std::vector<Import>> imports_;     ///< per part
};

}  // namespace ricochet
