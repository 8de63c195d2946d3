#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <numbers>

#include "ricochet/fem/reference_element.hpp"

/// @file Integration over the cells and facets of a block: shape functions tabulated once, the map evaluated per cell.
namespace ricochet {

/// Circumference of the circle of a point of an axisymmetric body at the given distance from the axis.
[[nodiscard]] inline double ring_length(double radius) { return 2.0 * std::numbers::pi * radius; }

/// Quadrature rule with the shape functions of geometry and displacement at its points.
struct BlockIntegration {
  QuadratureRule rule;
  Tabulation geometry;
  Tabulation displacement;
  /// Whether measures in the plane represent those of the rings that they sweep.
  bool axisymmetric = false;

  BlockIntegration(CellShape shape, int geometry_degree, int displacement_degree, int quadrature_degree,
                   bool is_of_rings = false)
      : BlockIntegration(quadrature(shape, quadrature_degree), shape, geometry_degree, displacement_degree,
                         is_of_rings) {}
  BlockIntegration(QuadratureRule of, CellShape shape, int geometry_degree, int displacement_degree, bool is_of_rings)
      : rule(std::move(of)),
        geometry(ReferenceElement::get(shape, geometry_degree).tabulate(rule.points)),
        displacement(ReferenceElement::get(shape, displacement_degree).tabulate(rule.points)),
        axisymmetric(is_of_rings) {}

  /// Distance of a point of the rule from the axis. `nodes` are those of the geometry.
  [[nodiscard]] double radius(const Points& coordinates, const Index* nodes, Index q) const {
    double result = 0.0;
    for (Index k = 0; k < geometry.values.rows(); ++k) result += geometry.values(k, q) * coordinates(0, nodes[k]);
    return result;
  }
  /// Factor of every measure at a point of the rule: the circumference of its ring, or 1.
  [[nodiscard]] double ring(const Points& coordinates, const Index* nodes, Index q) const {
    return axisymmetric ? ring_length(radius(coordinates, nodes, q)) : 1.0;
  }
};

/// Degree that integrates products of two shape functions exactly, including the determinant of the map and, in
/// axisymmetric bodies, the distance from the axis. If the map is not affine the stiffness is a rational function, for
/// which the same degree is adequate.
[[nodiscard]] inline int product_quadrature_degree(CellShape shape, int geometry_degree, int displacement_degree,
                                                   bool axisymmetric = false) {
  const int determinant =
      is_simplex(shape) ? dimension(shape) * (geometry_degree - 1) : dimension(shape) * geometry_degree - 1;
  return 2 * displacement_degree + determinant + (axisymmetric ? geometry_degree : 0);
}

/// Degree for the stiffness: on straight simplices the integrand is of degree 2(k−1). Hoop strains φ/r are rational
/// functions, polynomials only for affine displacements: they are integrated with the degree of the mass.
[[nodiscard]] inline int stiffness_quadrature_degree(CellShape shape, int geometry_degree, int displacement_degree,
                                                     bool axisymmetric = false) {
  if (axisymmetric) return product_quadrature_degree(shape, geometry_degree, displacement_degree, true);
  if (is_simplex(shape) && geometry_degree == 1) return displacement_degree == 1 ? 1 : 2;
  return product_quadrature_degree(shape, geometry_degree, displacement_degree);
}

/// Integration of the stiffness.
[[nodiscard]] inline BlockIntegration stiffness_integration(CellShape shape, int geometry_degree,
                                                            int displacement_degree, bool axisymmetric = false) {
  return {shape, geometry_degree, displacement_degree,
          stiffness_quadrature_degree(shape, geometry_degree, displacement_degree, axisymmetric), axisymmetric};
}

/// Sum over points close to the nodes of the displacement (not on the axis of an axisymmetric body), with equal
/// weights.
[[nodiscard]] inline BlockIntegration nodal_integration(CellShape shape, int geometry_degree, int displacement_degree,
                                                        bool axisymmetric = false) {
  constexpr double nearness = 0.99;
  const Points& nodes = ReferenceElement::get(shape, displacement_degree).nodes();
  const Vector centre = reference_centre(shape);
  const double weight = quadrature(shape, 0).weights.sum() / double(nodes.cols());
  QuadratureRule rule{(nearness * (nodes.colwise() - centre)).colwise() + centre,
                      Vector::Constant(nodes.cols(), weight)};
  return {std::move(rule), shape, geometry_degree, displacement_degree, axisymmetric};
}

/// Jacobian ∂x/∂ξ of the map of a cell: rows are components of x, columns reference directions.
/// `nodes` are the nodes of the cell.
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
