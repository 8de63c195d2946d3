#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/fem/isotropic_elasticity.hpp"

/// @file Mass and stiffness of one cell. Not part of the public interface.
///
/// The matrix of a cell is symmetric: only its blocks for pairs of nodes i ≤ j are computed, in the order (0,0), (0,1),
/// (1,1), (0,2), …, each row by row. For common cells the loops over nodes have a length known at compile time.
namespace ricochet {

/// Index of the pair i ≤ j; pair_number(0, n) is the number of pairs of n nodes.
constexpr int pair_number(int i, int j) { return j * (j + 1) / 2 + i; }

/// Nodes of a hexahedron of degree 2.
inline constexpr int most_cell_nodes = 27;

/// Integration of the mass on a block of cells.
struct MassIntegration {
  BlockIntegration block;
  /// Whether the map is affine, with one Jacobian per cell, and no other factor varies over the cell.
  bool affine = false;
  /// ∫ φ_i φ_j over the reference cell, per pair.
  std::vector<double> reference;

  MassIntegration(CellShape shape, int geometry_degree, int displacement_degree, bool axisymmetric = false)
      : block(shape, geometry_degree, displacement_degree,
              product_quadrature_degree(shape, geometry_degree, displacement_degree, axisymmetric), axisymmetric),
        affine(!axisymmetric && geometry_degree == 1 && is_simplex(shape)) {
    const Matrix& values = block.displacement.values;
    for (Index j = 0; j < values.rows(); ++j) {
      for (Index i = 0; i <= j; ++i) {
        double sum = 0.0;
        for (Index q = 0; q < values.cols(); ++q) sum += block.rule.weights[q] * (values(i, q) * values(j, q));
        reference.push_back(sum);
      }
    }
  }
};

/// Computes ∫ ρ φ_i φ_j over a cell: one number per pair of nodes. `nodes` are those of the geometry.
template <int d>
void element_mass(const MassIntegration& integration, const Points& coordinates, const Index* nodes, double density,
                  double* result) {
  const Matrix& values = integration.block.displacement.values;
  const auto measure = [&](std::size_t q) {
    return density * jacobian<d>(coordinates, nodes, integration.block.geometry.gradients[q]).determinant() *
           integration.block.ring(coordinates, nodes, Index(q));
  };
  if (integration.affine) {
    const double factor = measure(0);
    for (std::size_t pair = 0; pair < integration.reference.size(); ++pair)
      result[pair] = factor * integration.reference[pair];
    return;
  }
  std::fill_n(result, integration.reference.size(), 0.0);
  for (Index q = 0; q < values.cols(); ++q) {
    const double factor = integration.block.rule.weights[q] * measure(std::size_t(q));
    double* pair = result;
    for (Index j = 0; j < values.rows(); ++j) {
      for (Index i = 0; i <= j; ++i) *pair++ += factor * (values(i, q) * values(j, q));
    }
  }
}

/// Adds the tangent for all pairs of nodes with the gradients g, node by node.
template <int d, int fixed_count>
void add_elastic_pairs(const double* gradients, int count, const IsotropicElasticity& law, double* result) {
  const int nodes = fixed_count > 0 ? fixed_count : count;
  for (int j = 0; j < nodes; ++j) {
    for (int i = 0; i <= j; ++i, result += d * d) {
      law.add_tangent<d>(gradients + i * d, gradients + j * d, result);
    }
  }
}

/// Adds the contribution of the hoop strains φ/r of axisymmetric bodies to the tangent for all pairs of nodes.
inline void add_hoop_pairs(const BlockIntegration& integration, double radius, Index q, const double* gradients,
                           const IsotropicElasticity& law, double* result) {
  const Matrix& values = integration.displacement.values;
  for (Index j = 0; j < values.rows(); ++j) {
    for (Index i = 0; i <= j; ++i, result += 4)
      law.add_hoop_tangent(gradients + 2 * i, values(i, q) / radius, gradients + 2 * j, values(j, q) / radius, result);
  }
}

/// Computes ∫ A ε(φ_i e_a) : ε(φ_j e_b) over a cell, d × d numbers per pair of nodes.
/// `nodes` are those of the geometry.
template <int d>
void element_stiffness(const BlockIntegration& integration, const Points& coordinates, const Index* nodes,
                       const IsotropicElasticity& law, double* result) {
  const int count = int(integration.displacement.values.rows());
  std::array<double, most_cell_nodes * d> gradients;
  std::fill_n(result, pair_number(0, count) * d * d, 0.0);
  for (std::size_t q = 0; q < integration.geometry.gradients.size(); ++q) {
    const Eigen::Matrix<double, d, d> map = jacobian<d>(coordinates, nodes, integration.geometry.gradients[q]);
    const Eigen::Matrix<double, d, d> inverse = map.inverse();
    const auto point = Index(q);
    const double measure =
        integration.rule.weights[point] * map.determinant() * integration.ring(coordinates, nodes, point);
    const IsotropicElasticity weighted{measure * law.lambda, measure * law.mu};
    const Matrix& reference = integration.displacement.gradients[q];
    for (int i = 0; i < count; ++i) {
      for (int a = 0; a < d; ++a) {
        double sum = reference(i, 0) * inverse(0, a);
        for (int k = 1; k < d; ++k) sum += reference(i, k) * inverse(k, a);
        gradients[std::size_t(i * d + a)] = sum;
      }
    }
    if (count == d + 1) {
      add_elastic_pairs<d, d + 1>(gradients.data(), count, weighted, result);
    } else if (count == (d + 1) * (d + 2) / 2) {
      add_elastic_pairs<d, (d + 1) * (d + 2) / 2>(gradients.data(), count, weighted, result);
    } else {
      add_elastic_pairs<d, 0>(gradients.data(), count, weighted, result);
    }
    if constexpr (d == 2) {
      if (integration.axisymmetric) {
        add_hoop_pairs(integration, integration.radius(coordinates, nodes, point), point, gradients.data(), weighted,
                       result);
      }
    }
  }
}

}  // namespace ricochet
