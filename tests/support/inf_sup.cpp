#include "support/inf_sup.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "ricochet/base/error.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"

namespace ricochet::test_support {

namespace {

/// Returns ∫ |∇v|² + v²/L² on the nodes that are not held. `number` receives each node's unknown, or −1.
SparseMatrix norm_matrix(const Body& body, const std::function<bool(Index)>& is_held, std::vector<int>& number) {
  // With λ = −μ the diagonal blocks of the elastic stiffness are those of the Laplacian: (λ + μ) ∂_a v ∂_a w vanishes.
  Body scalar = body;
  Material laplacian;
  laplacian.density = 1.0;
  laplacian.law = make_linear_elasticity(-1.0, 1.0);
  scalar.plane = PlaneState::strain;
  scalar.materials.assign(body.materials.size(), laplacian);
  const NodeGraph graph = node_graph(*body.space);
  const SparseMatrix stiffness = assemble_stiffness(scalar, graph);
  const SparseMatrix mass = assemble_scalar_mass(scalar, graph);
  const double length = extent(body.space->nodes);
  int count = 0;
  number.assign(std::size_t(body.space->node_count()), -1);
  for (Index node = 0; node < body.space->node_count(); ++node) {
    if (!is_held || !is_held(node)) number[std::size_t(node)] = count++;
  }
  const int d = body.space->dimension;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index row, Index column, double value) {
    const int i = number[std::size_t(row)];
    const int j = number[std::size_t(column)];
    if (i >= 0 && j >= 0) entries.emplace_back(i, j, value);
  };
  for (Index column = 0; column < body.space->node_count(); ++column) {
    for (SparseMatrix::InnerIterator entry(stiffness, column * d); entry; ++entry) {
      if (entry.row() % d == 0) add(entry.row() / d, column, entry.value());
    }
    for (SparseMatrix::InnerIterator entry(mass, column); entry; ++entry) {
      add(entry.row(), column, entry.value() / (length * length));
    }
  }
  SparseMatrix result(count, count);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// Numbers the multipliers in use, by anchor.
std::map<Index, Index> number_multipliers(const MultiplierSpace& space) {
  std::map<Index, Index> number;
  for (const Multiplier& multiplier : space.multipliers()) {
    if (only_presses_supports(multiplier, space.patch())) continue;
    number.emplace(multiplier.node >= 0 ? multiplier.node : multiplier.facet, number.size());
  }
  return number;
}

/// Computes Cᵀ, unknowns × multipliers, and H.
void boundary_products(const MultiplierSpace& space, const std::vector<int>& unknown,
                       const std::map<Index, Index>& number, Matrix& coupling, Matrix& norm) {
  const Body& body = *space.patch().body;
  const FacetIntegration integration(body);
  FacetQuadrature quadrature;
  FacetMultipliers functions;
  for (const Index facet : space.patch().parts.front().facets) {
    integration.evaluate(facet, quadrature);
    space.evaluate(quadrature, functions);
    const double size = std::pow(quadrature.measure.sum(), 1.0 / (body.space->dimension - 1));
    const Matrix weighted = functions.values * quadrature.measure.asDiagonal();
    const Matrix with_displacement = weighted * quadrature.displacement->transpose();
    const Matrix with_itself = size * weighted * functions.values.transpose();
    for (std::size_t a = 0; a < functions.anchors.size(); ++a) {
      const auto row = number.find(functions.anchors[a]);
      if (row == number.end()) continue;
      for (Index j = 0; j < quadrature.node_count(); ++j) {
        const int at = unknown[std::size_t(quadrature.nodes[j])];
        if (at >= 0) coupling(at, row->second) += with_displacement(Index(a), j);
      }
      for (std::size_t b = 0; b < functions.anchors.size(); ++b) {
        const auto column = number.find(functions.anchors[b]);
        if (column == number.end()) continue;
        norm(row->second, column->second) += with_itself(Index(a), Index(b));
      }
    }
  }
}

}  // namespace

double inf_sup_constant(const Body& body, const std::vector<Index>& facets, const std::string& multipliers,
                        const std::function<bool(Index node)>& is_held) {
  const ContactPatch patch{&body, {{0, facets}}, is_held};
  const std::unique_ptr<MultiplierSpace> space = make_multiplier_space(multipliers, patch);
  std::vector<int> unknown;
  const SparseMatrix norm = norm_matrix(body, is_held, unknown);
  const std::map<Index, Index> number = number_multipliers(*space);
  if (number.empty()) return std::numeric_limits<double>::infinity();
  const auto count = Index(number.size());
  Matrix coupling = Matrix::Zero(norm.rows(), count);
  Matrix multiplier_norm = Matrix::Zero(count, count);
  boundary_products(*space, unknown, number, coupling, multiplier_norm);
  const Eigen::SimplicialLLT<SparseMatrix> factor(norm);
  if (factor.info() != Eigen::Success) throw Error(ErrorKind::invalid_input, "the H¹ norm's matrix is not definite");
  const Matrix supremum = coupling.transpose() * factor.solve(coupling);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> eigen(0.5 * (supremum + supremum.transpose()), multiplier_norm,
                                                               Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(eigen.eigenvalues()[0], 0.0));
}

}  // namespace ricochet::test_support
