#pragma once

#include <vector>

#include "ricochet/linear_algebra/matrix_graph.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/stage/stage_product.hpp"
#include "ricochet/step/stage.hpp"

/// @file Neighbourhood of contact points, by the cells of the body. Functions are collective over the ranks, each with
/// its own points.
namespace ricochet {

class ContactNeighbourhood {
 public:
  /// Number of layers above which iterations are cheaper than subdomains, whose cost grows with the cube of their
  /// layers.
  static constexpr int max_layers = 12;

  /// Keeps a reference to the problem. The graph is that of its cells (an equivalent mass has more distant neighbours).
  explicit ContactNeighbourhood(const SemidiscreteProblem& problem) : problem_(problem) {}
  /// Uses another graph.
  ContactNeighbourhood(const SemidiscreteProblem& problem, MatrixGraph graph)
      : problem_(problem), graph_(std::move(graph)) {}

  [[nodiscard]] const MatrixGraph& graph();
  /// Nodes of these points; some may occur more than once.
  [[nodiscard]] std::vector<Index> nodes_of(const std::vector<Index>& points) const;
  /// Nodes within so many layers of those of the points of all ranks. Ascending.
  [[nodiscard]] std::vector<Index> nodes_around(const std::vector<Index>& points, int layers);
  /// Points with some node within a few layers of those of the given ones, including these: a growing contact should
  /// not require other subdomains in every step. Ascending.
  [[nodiscard]] std::vector<Index> points_around(const std::vector<Index>& points);
  /// Number of layers of nodes around points in which the influence of the rest of the body on their contact has
  /// decayed, for A = αM + κK of this product.
  [[nodiscard]] int layers_to_solve(const std::vector<Index>& points, const OperatorCoefficients& coefficients,
                                    const StageProduct& product);

 private:
  const SemidiscreteProblem& problem_;
  MatrixGraph graph_;
};

/// Number of cells that a pressure wave crosses in the step of A = αM + κK near these nodes, √(Σ κ K_ii / Σ α m_i) with
/// the row sums m of M, over the dofs with inertia. On tetrahedra of degree 1 with α = 4/h², κ = 1 it is accurate to a
/// twentieth. Infinite without inertia. Collective over the ranks, each with all of these nodes that it has.
[[nodiscard]] double cells_crossed(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                   const StageProduct& product, const std::vector<Index>& nodes);

}  // namespace ricochet
