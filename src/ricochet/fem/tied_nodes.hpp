#pragma once

#include <utility>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Tied nodes: surfaces glued together on non-matching meshes.
namespace ricochet {

/// Ties u_s = Σ_m P_sm u_m at the tied nodes s, with Σ_m P_sm = 1. With T, which maps the values of the other nodes to
/// those of all nodes, matrices and loads become TᵀAT and TᵀL: rows and columns of tied nodes are then zero, and their
/// values are filled in (complete) when needed. Virtual work and energy are those of the motion u = T u_m, so that
/// nothing is lost between the surfaces.
class TiedNodes {
 public:
  using Weights = std::vector<std::pair<Index, double>>;
  struct Tie {
    Index node = 0;
    Weights weights;  ///< (node, P)
  };

  TiedNodes() = default;
  /// Constructs from ties of one node each, in any order; the nodes of a tie may be tied themselves. Throws
  /// Error(invalid_input) if ties form a cycle.
  TiedNodes(std::vector<Tie> ties, Index node_count);

  [[nodiscard]] bool empty() const { return ties_.empty(); }
  [[nodiscard]] bool is_tied(Index node) const { return !ties_.empty() && tie_of_node_[std::size_t(node)] >= 0; }
  /// Ties by ascending node; their weights refer to untied nodes only.
  [[nodiscard]] const std::vector<Tie>& ties() const { return ties_; }

  /// Expresses a linear functional in terms of untied nodes.
  [[nodiscard]] Weights spread(const Weights& weights) const;
  /// TᵀAT with A on nodes (components = 1) or dofs, exactly symmetric.
  [[nodiscard]] SparseMatrix condense(const SparseMatrix& matrix, int components) const;
  /// TᵀAT of a matrix that need not be symmetric.
  [[nodiscard]] SparseMatrix condense_general(const SparseMatrix& matrix, int components) const;
  /// TᵀL, d components per node.
  void condense_load(Vector& load, int d) const;
  /// Fills in the values of the tied nodes.
  void complete(Vector& values, int d) const;

 private:
  std::vector<Tie> ties_;
  std::vector<int> tie_of_node_;  ///< −1 if not tied
};

}  // namespace ricochet
