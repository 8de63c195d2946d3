#include "ricochet/solver/subdomain/contact_neighbourhood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

/// Layers of nodes around the points that required subdomains.
constexpr int reserve_layers = 3;
/// Layers per cell that a wave crosses in a step, behind which the influence of the rest of the body on the contact has
/// decayed to a tenth.
constexpr double layers_per_cell_crossed = 1.2;
constexpr int min_layers = 2;

double cells_crossed(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                     const StageProduct& product, const std::vector<Index>& nodes) {
  if (coefficients.mass == 0.0) return std::numeric_limits<double>::infinity();
  // Ranks have parts of inertia and stiffness.
  Vector inertia, whole;
  problem.mass.multiply(Vector::Ones(problem.dof_count()), inertia);
  whole = inertia;
  problem.ranks->accumulate(whole);
  const Vector elastic = product.diagonal() - coefficients.mass * problem.mass.diagonal();
  double stiff = 0.0, heavy = 0.0;
  for (const Index node : nodes) {
    for (Index dof = node * problem.dimension; dof < (node + 1) * problem.dimension; ++dof) {
      if (!(whole[dof] > 0.0)) continue;
      stiff += elastic[dof];
      heavy += coefficients.mass * inertia[dof];
    }
  }
  stiff = problem.ranks->sum(stiff);
  heavy = problem.ranks->sum(heavy);
  return heavy > 0.0 ? std::sqrt(std::max(stiff, 0.0) / heavy) : std::numeric_limits<double>::infinity();
}

const MatrixGraph& ContactNeighbourhood::graph() {
  if (graph_.size() == 0) graph_ = problem_.internal_force->graph(problem_.dimension);
  return graph_;
}

std::vector<Index> ContactNeighbourhood::nodes_of(const std::vector<Index>& points) const {
  std::vector<Index> nodes;
  for (const Index point : points)
    problem_.contact.visit_nodes(point, [&](Index node, double) { nodes.push_back(node); });
  return nodes;
}

std::vector<Index> ContactNeighbourhood::nodes_around(const std::vector<Index>& points, int layers) {
  std::vector<Index> nodes = nodes_of(points);
  if (!problem_.ranks->are_several()) return nodes_within(graph(), nodes, layers).ascending();
  Vector reached = Vector::Zero(problem_.nodes.cols());
  for (int layer = 0; layer <= layers; ++layer) {
    for (const Index node : layer == 0 ? nodes : nodes_within(graph(), nodes, 1).nodes) reached[node] = 1.0;
    problem_.ranks->accumulate(reached);
    nodes.clear();
    for (Index node = 0; node < reached.size(); ++node) {
      if (reached[node] > 0.0) nodes.push_back(node);
    }
  }
  return nodes;
}

std::vector<Index> ContactNeighbourhood::points_around(const std::vector<Index>& points) {
  std::vector<char> reached(static_cast<std::size_t>(problem_.nodes.cols()), 0);
  for (const Index node : nodes_around(points, reserve_layers)) reached[std::size_t(node)] = 1;
  std::vector<Index> result;
  for (Index point = 0; point < problem_.contact.size(); ++point) {
    bool inside = false;
    problem_.contact.visit_nodes(point,
                                 [&](Index node, double) { inside = inside || reached[std::size_t(node)] != 0; });
    if (inside) result.push_back(point);
  }
  return result;
}

int ContactNeighbourhood::layers_to_solve(const std::vector<Index>& points, const OperatorCoefficients& coefficients,
                                          const StageProduct& product) {
  const double crossed = cells_crossed(problem_, coefficients, product, nodes_around(points, reserve_layers));
  return int(std::clamp(std::ceil(layers_per_cell_crossed * crossed), 1.0 * min_layers, 1.0 * max_layers));
}

}  // namespace ricochet
