#pragma once

#include <utility>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Nodes that follow others: surfaces that are glued together on meshes that do not match.
namespace ricochet {

/// u_s = Σ_m P_sm u_m at the tied nodes s, with Σ_m P_sm = 1. With T, which gives all nodes' values from those of the
/// others, matrices and loads become TᵀAT and TᵀL: rows and columns of tied nodes are then zero, and their values are
/// filled in (complete) where somebody looks at them. Virtual work and energy are those of the motion u = T u_m, so
/// nothing is lost between the surfaces.
class TiedNodes {
 public:
  using Weights = std::vector<std::pair<Index, double>>;
  struct Tie {
    Index node = 0;
    Weights weights;  ///< (node, P)
  };

  TiedNodes() = default;
  /// Ties of one node each, in any order; nodes that are followed may be tied themselves. Throws Error(invalid_input)
  /// where nodes follow each other in a circle.
  TiedNodes(std::vector<Tie> ties, Index node_count);

  [[nodiscard]] bool empty() const { return ties_.empty(); }
  [[nodiscard]] bool is_tied(Index node) const {
    return !ties_.empty() && tie_of_node_[static_cast<std::size_t>(node)] >= 0;
  }
  /// By ascending node; what they follow is not tied.
  [[nodiscard]] const std::vector<Tie>& ties() const { return ties_; }

  /// The same functional on nodes that are not tied.
  [[nodiscard]] Weights spread(const Weights& weights) const;
  /// TᵀAT with A on nodes (components 1) or dofs, symmetric to the bit.
  [[nodiscard]] SparseMatrix condense(const SparseMatrix& matrix, int components) const;
  /// TᵀL, d components per node.
  void condense_load(Vector& load, int d) const;
  /// Gives tied nodes the values that they follow.
  void complete(Vector& values, int d) const;

 private:
  std::vector<Tie> ties_;
  std::vector<int> tie_of_node_;  ///< −1: not tied
};

}  // namespace ricochet
