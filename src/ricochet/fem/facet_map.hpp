#pragma once

#include "ricochet/fem/facet_integration.hpp"
#include "ricochet/fem/polynomial_shape.hpp"

/// @file Boundary facets at any of their points: the map of the geometry, its inverse in a projection, and shape
/// functions.
namespace ricochet {

/// The points of a facet that are asked about, with what FacetQuadrature refers to.
struct FacetPoints {
  Points local;                ///< reference coordinates, (d−1) × points
  Matrix displacement, hats;   ///< as in FacetQuadrature
  FacetQuadrature quadrature;  ///< of these points, for spaces of multipliers; refers to the matrices above
};

class FacetMap {
 public:
  /// Keeps a reference to the body.
  explicit FacetMap(const Body& body);

  /// x(ξ) of each point, d × points.
  void positions(Index facet, const Points& local, Points& result) const;
  /// The reference coordinates ξ at which axesᵀ x(ξ) = y: those of the points of a facet that are seen at `plane`,
  /// (d−1) × points, along the direction that the axes, d × (d−1), are perpendicular to. Newton's method from
  /// where the last point leads, or from the facet's centre; false where it finds none, since the facet is seen
  /// edge-on.
  [[nodiscard]] bool invert(Index facet, const Points& axes, const Points& plane, Points& local) const;
  /// Shape functions at points.local. `weights` are areas in the plane of the axes, from which the measures on the
  /// facet come: the area of the facet over that of its projection.
  void evaluate(Index facet, const Points& axes, const Vector& weights, FacetPoints& points) const;
  /// Area per reference area, in two dimensions length; of axisymmetric bodies that of the ring.
  [[nodiscard]] double density(const PolynomialMap<3>::Place& at) const;
  /// x(ξ) with the derivatives along the axes of the reference facet; a third component is 0 in two dimensions.
  [[nodiscard]] PolynomialMap<3> map_of(Index facet) const;
  /// Shape functions of the displacement, and the hat functions of the vertices, at points: nodes × points.
  void displacement(Index facet, const Points& local, Matrix& values) const;
  void hats(Index facet, const Points& local, Matrix& values) const;

 private:
  struct Shapes {
    PolynomialShape geometry, displacement, hats;
  };
  [[nodiscard]] PolynomialMap<3> geometry(const PlaceInBlocks& place) const;

  const Body& body_;
  std::vector<Shapes> shapes_;  ///< per block of facets
};

}  // namespace ricochet
