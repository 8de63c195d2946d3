#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Cells in packs, whose loops take one number of each cell at once, and where the forces of their nodes go. Not
/// part of the public interface.
///
/// The parts are those of the graph: a cell is of the part that most of its nodes are of. (Without a graph they are
/// runs of cells.) A part works on numbers of its own, one after another for all nodes of its cells; what belongs to
/// nodes of another part is added there when all parts are done, in the order of the parts. So every cell is computed
/// once, and the bits are the same for any number of threads.
namespace ricochet {

/// Numbers of a node side by side in memory: the components of a vector, and a zero in space, for packs of two or four.
template <int d>
inline constexpr int node_stride = d == 2 ? 2 : 4;

/// Packs one after another, of one part, block and material.
struct PackRun {
  std::size_t block = 0;
  int material = 0;
  Index begin = 0, end = 0;  ///< packs of the block
};

class CellPacks {
 public:
  /// Of these cells, ascending; empty: of all. Keeps nothing of what it is made from.
  CellPacks(const Body& body, const NodeGraph* graph, const std::vector<int>& cells);

  [[nodiscard]] Index parts() const { return static_cast<Index>(runs_.size()); }
  [[nodiscard]] const std::vector<PackRun>& runs(Index part) const { return runs_[static_cast<std::size_t>(part)]; }
  /// Of a block: the cells (within the block) of all lanes, pack after pack; −1 where a pack is not full.
  [[nodiscard]] const std::vector<int>& lanes(std::size_t block) const { return lanes_[block]; }
  /// Where, among the part's own, the numbers of a node of a lane are: per pack and node of the cell one per lane. All
  /// nodes of a lane that is not used are one that is of no cell.
  [[nodiscard]] const std::vector<int>& slots(std::size_t block) const { return slots_[block]; }

  /// Room for the numbers of all parts, zero.
  template <int d>
  [[nodiscard]] std::vector<double> room() const {
    return std::vector<double>(nodes_.size() * node_stride<d>, 0.0);
  }
  /// Where those of a part begin in it.
  template <int d>
  [[nodiscard]] Index begin(Index part) const {
    return begins_[static_cast<std::size_t>(part)] * node_stride<d>;
  }
  /// Copies a vector per dof to the numbers of a part.
  template <int d>
  void read(Index part, const Vector& from, std::vector<double>& room) const;
  /// Sets those of a part to zero.
  template <int d>
  void clear(Index part, std::vector<double>& room) const;
  /// A vector per dof of the sums of all parts.
  template <int d>
  void add_up(const std::vector<double>& room, Vector& result) const;

 private:
  struct Import {
    int node;  ///< of the body
    int place;
  };
  void share_out(const Body& body, const NodeGraph* graph, const std::vector<int>& cells);
  void number_nodes(const Body& body, const NodeGraph* graph);

  Index node_count_ = 0;
  std::vector<std::vector<PackRun>> runs_;       ///< per part
  std::vector<std::vector<int>> lanes_, slots_;  ///< per block
  std::vector<Index> begins_;                    ///< per part, and the end
  std::vector<int> nodes_;                       ///< per place the node; −1: the one that is of no cell
  std::vector<Index> own_;                       ///< per part how many of its places are of nodes of its own
  std::vector<std::vector<Import>> imports_;     ///< per part
};

}  // namespace ricochet
