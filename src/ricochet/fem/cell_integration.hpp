#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "ricochet/fem/reference_element.hpp"

/// @file Integration over the cells and facets of one block: shape functions tabulated once, the map evaluated per
/// cell.
namespace ricochet {

/// Length of the circle on which a point of an axisymmetric body lies, at this distance from the axis.
[[nodiscard]] inline double ring_length(double radius) {
  return 2.0 * std::numbers::pi * radius;
}

/// A quadrature rule with the geometry's and the displacement's shape functions at its points.
struct BlockIntegration {
  QuadratureRule rule;
  Tabulation geometry;
  Tabulation displacement;
  /// Measures in the plane stand for those of the rings that they sweep.
  bool axisymmetric = false;

  BlockIntegration(CellShape shape, int geometry_degree, int displacement_degree, int quadrature_degree,
                   bool is_of_rings = false)
      : rule(quadrature(shape, quadrature_degree)),
        geometry(ReferenceElement::get(shape, geometry_degree).tabulate(rule.points)),
        displacement(ReferenceElement::get(shape, displacement_degree).tabulate(rule.points)),
        axisymmetric(is_of_rings) {}

  /// Distance of a point of the rule from the axis. `nodes` are the geometry's.
  [[nodiscard]] double radius(const Points& coordinates, const Index* nodes, Index q) const {
    double result = 0.0;
    for (Index k = 0; k < geometry.values.rows(); ++k) result += geometry.values(k, q) * coordinates(0, nodes[k]);
    return result;
  }
  /// What every measure at a point of the rule has as a factor: the length of its ring, or 1.
  [[nodiscard]] double ring(const Points& coordinates, const Index* nodes, Index q) const {
    return axisymmetric ? ring_length(radius(coordinates, nodes, q)) : 1.0;
  }
};

/// Degree that integrates products of two shape functions exactly, the determinant of the map included, and the
/// distance from the axis in axisymmetric bodies. The stiffness of a map that is not affine is a rational function; the
/// same degree serves it well.
[[nodiscard]] inline int product_quadrature_degree(CellShape shape, int geometry_degree, int displacement_degree,
                                                   bool axisymmetric = false) {
  const bool simplex = shape == CellShape::triangle || shape == CellShape::tetrahedron || shape == CellShape::interval;
  const int determinant = simplex ? dimension(shape) * (geometry_degree - 1) : dimension(shape) * geometry_degree - 1;
  return 2 * displacement_degree + determinant + (axisymmetric ? geometry_degree : 0);
}

/// Degree for the stiffness: on straight simplices the integrand is of degree 2(k−1). Hoop strains φ/r are rational
/// functions, of which only those of affine displacements are polynomials: they get the degree of the mass.
[[nodiscard]] inline int stiffness_quadrature_degree(CellShape shape, int geometry_degree, int displacement_degree,
                                                     bool axisymmetric = false) {
  if (axisymmetric) return product_quadrature_degree(shape, geometry_degree, displacement_degree, true);
  const bool simplex = shape == CellShape::triangle || shape == CellShape::tetrahedron;
  if (simplex && geometry_degree == 1) return displacement_degree == 1 ? 1 : 2;
  return product_quadrature_degree(shape, geometry_degree, displacement_degree);
}

/// What the stiffness is integrated with.
[[nodiscard]] inline BlockIntegration stiffness_integration(CellShape shape, int geometry_degree,
                                                            int displacement_degree, bool axisymmetric = false) {
  return {shape, geometry_degree, displacement_degree,
          stiffness_quadrature_degree(shape, geometry_degree, displacement_degree, axisymmetric), axisymmetric};
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
