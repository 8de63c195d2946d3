#pragma once

#include <vector>

#include "ricochet/linear_algebra/matrix_graph.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"
#include "ricochet/solver/stage/stage_product.hpp"

/// @file What is how near to contact points, by the cells of the body. Several ranks ask together, each about points of
/// its own.
namespace ricochet {

class PointsNearby {
 public:
  /// Where a wave crosses more cells, rounds are cheaper than zones that grow with the cube of their layers.
  static constexpr int most_layers = 12;

  /// Keeps a reference to the problem. The graph is that of its cells (an equivalent mass has neighbours farther away).
  explicit PointsNearby(const SemidiscreteProblem& problem) : problem_(problem) {}
  /// With another graph.
  PointsNearby(const SemidiscreteProblem& problem, MatrixGraph graph) : problem_(problem), graph_(std::move(graph)) {}

  [[nodiscard]] const MatrixGraph& graph();
  /// That the points see; some may be there more than once.
  [[nodiscard]] std::vector<Index> nodes_of(const std::vector<Index>& points) const;
  /// Nodes within so many layers of those of the points of all ranks. Ascending.
  [[nodiscard]] std::vector<Index> nodes_around(const std::vector<Index>& points, int layers);
  /// Points with some node within a few layers of those of the given ones, and these: a contact that grows should not
  /// ask for other zones in every step. Ascending.
  [[nodiscard]] std::vector<Index> points_around(const std::vector<Index>& points);
  /// Layers of nodes around points in which what the rest of the body does to their contact has decayed, for
  /// A = αM + κK of this product.
  [[nodiscard]] int layers_to_solve(const std::vector<Index>& points, const OperatorCoefficients& coefficients,
                                    const StageProduct& product);

 private:
  const SemidiscreteProblem& problem_;
  MatrixGraph graph_;
};

/// The cells that a pressure wave crosses in the step of A = αM + κK near these nodes, √(Σ κ K_ii / Σ α m_i) with the
/// sums m of the rows of M, over the dofs with inertia. On tetrahedra of degree 1 with α = 4/h², κ = 1 it is that
/// within a twentieth. Infinite without inertia. Several ranks ask together, each with all of these nodes that it has.
[[nodiscard]] double cells_crossed(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                   const StageProduct& product, const std::vector<Index>& nodes);

}  // namespace ricochet
