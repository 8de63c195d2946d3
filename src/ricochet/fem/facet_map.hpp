#pragma once

#include "ricochet/fem/facet_integration.hpp"
#include "ricochet/fem/polynomial_shape.hpp"

/// @file Maps of boundary facets: the map of the geometry, its inverse in a projection, and
/// shape functions at any point.
namespace ricochet {

/// Points on a facet, with the data to which their FacetQuadrature refers.
struct FacetPoints {
  Points local;                ///< reference coordinates, (d−1) × points
  Matrix displacement, hats;   ///< as in FacetQuadrature
  FacetQuadrature quadrature;  ///< of these points, for multiplier spaces; refers to the matrices above
};

class FacetMap {
 public:
  /// Keeps a reference to the body.
  explicit FacetMap(const Body& body);

  /// Computes x(ξ) of each point, d × points.
  void positions(Index facet, const Points& local, Points& result) const;
  /// Computes the reference coordinates ξ with axesᵀ x(ξ) = y: the points of a facet whose projection along
  /// the direction perpendicular to the axes, d × (d−1), is `plane`, (d−1) × points. Newton's method starts
  /// from an extrapolation of the last point, or from the facet's centre; returns false if it does not
  /// converge because the facet is seen edge-on.
  [[nodiscard]] bool invert(Index facet, const Points& axes, const Points& plane, Points& local) const;
  /// Evaluates the shape functions at points.local. `weights` are areas in the plane of the axes; the measures on the
  /// facet are these times the ratio of the facet's area to that of its projection.
  void evaluate(Index facet, const Points& axes, const Vector& weights, FacetPoints& points) const;
  /// Area per reference area, in 2D length; in axisymmetric bodies that of the ring.
  [[nodiscard]] double density(const PolynomialMap<3>::Evaluation& at) const;
  /// Map x(ξ) with its derivatives along the axes of the reference facet; the third component is 0 in 2D.
  [[nodiscard]] PolynomialMap<3> map_of(Index facet) const;
  /// Evaluate the shape functions of the displacement, and the hat functions of the
  /// vertices, at points: nodes × points.
  void displacement(Index facet, const Points& local, Matrix& values) const;
  void hats(Index facet, const Points& local, Matrix& values) const;

 private:
  struct Shapes {
    PolynomialShape geometry, displacement, hats;
  };
  [[nodiscard]] PolynomialMap<3> geometry(const IndexInBlocks& location) const;

  const Body& body_;
  std::vector<Shapes> shapes_;  ///< per block of facets
};

}  // namespace ricochet
