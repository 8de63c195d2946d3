#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "ricochet/fem/reference_element.hpp"

/// @file Integration over the cells and facets of one block: shape functions tabulated once, the map evaluated per
/// cell.
namespace ricochet {

/// A quadrature rule with the geometry's and the displacement's shape functions at its points.
struct BlockIntegration {
  QuadratureRule rule;
  Tabulation geometry;
  Tabulation displacement;

  BlockIntegration(CellShape shape, int geometry_degree, int displacement_degree, int quadrature_degree)
      : rule(quadrature(shape, quadrature_degree)),
        geometry(ReferenceElement::get(shape, geometry_degree).tabulate(rule.points)),
        displacement(ReferenceElement::get(shape, displacement_degree).tabulate(rule.points)) {}
};

/// Degree that integrates products of two shape functions exactly, the determinant of the map included. The stiffness
/// of a map that is not affine is a rational function; the same degree serves it well.
[[nodiscard]] inline int product_quadrature_degree(CellShape shape, int geometry_degree, int displacement_degree) {
  const bool simplex = shape == CellShape::triangle || shape == CellShape::tetrahedron || shape == CellShape::interval;
  const int determinant = simplex ? dimension(shape) * (geometry_degree - 1) : dimension(shape) * geometry_degree - 1;
  return 2 * displacement_degree + determinant;
}

/// Degree for the stiffness: on straight simplices the integrand is of degree 2(k−1).
[[nodiscard]] inline int stiffness_quadrature_degree(CellShape shape, int geometry_degree, int displacement_degree) {
  const bool simplex = shape == CellShape::triangle || shape == CellShape::tetrahedron;
  if (simplex && geometry_degree == 1) return displacement_degree == 1 ? 1 : 2;
  return product_quadrature_degree(shape, geometry_degree, displacement_degree);
}

/// What the stiffness is integrated with.
[[nodiscard]] inline BlockIntegration stiffness_integration(CellShape shape, int geometry_degree,
                                                            int displacement_degree) {
  return {shape, geometry_degree, displacement_degree,
          stiffness_quadrature_degree(shape, geometry_degree, displacement_degree)};
}

/// Jacobian ∂x/∂ξ of the map of a cell: rows are components of x, columns reference directions. `nodes` are its node
/// numbers.
template <int space_dimension, int cell_dimension = space_dimension>
Eigen::Matrix<double, space_dimension, cell_dimension> jacobian(const Points& coordinates, const Index* nodes,
                                                                const Matrix& gradients) {
  Eigen::Matrix<double, space_dimension, cell_dimension> result;
  result.setZero();
  for (Index k = 0; k < gradients.rows(); ++k) {
    result +=
        coordinates.template block<space_dimension, 1>(0, nodes[k]) * gradients.template block<1, cell_dimension>(k, 0);
  }
  return result;
}

/// Measure of a facet per reference measure: √det(JᵀJ).
template <int space_dimension>
double facet_measure(const Eigen::Matrix<double, space_dimension, space_dimension - 1>& facet_jacobian) {
  if constexpr (space_dimension == 2) {
    return facet_jacobian.norm();
  } else {
    const Eigen::Vector3d first = facet_jacobian.col(0);
    return first.cross(facet_jacobian.col(1)).norm();
  }
}

}  // namespace ricochet
