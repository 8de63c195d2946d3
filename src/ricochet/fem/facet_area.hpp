#pragma once

#include <vector>

#include "ricochet/fem/polynomial_shape.hpp"

/// @file Areas of parts of a facet, where a displacement has moved it.
namespace ricochet {

/// Reference facets of one shape.
struct FacetShape {
  bool is_segment, is_triangle;
  PolynomialShape geometry, displacement;
  Points rule_points;
  Vector rule_weights;
  std::vector<int> border;  ///< nodes of the displacement on its border, going round, or from end to end of a segment
  Points border_points;     ///< their reference coordinates
};
[[nodiscard]] FacetShape make_facet_shape(CellShape shape, int geometry_degree, int displacement_degree,
                                          bool axisymmetric);

/// ∫ |∂(X + u)/∂ξ| dξ over parts of one facet: an area, in the plane a length, of axisymmetric bodies that of the ring.
class FacetArea {
 public:
  using Places = PolynomialMap<3>::NodePlaces;
  /// `places`: X of the geometry's nodes; `motions`: u of the displacement's nodes. Keeps a reference to the shape.
  FacetArea(const FacetShape& shape, const Places& places, const Places& motions, bool axisymmetric);

  [[nodiscard]] double whole() const;
  /// From one reference coordinate of a segment to another.
  [[nodiscard]] double segment(double from, double to) const;
  /// Between three points of the reference facet; negative where they turn clockwise.
  [[nodiscard]] double triangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) const;

 private:
  [[nodiscard]] double density(const double* point) const;

  const FacetShape& shape_;
  bool axisymmetric_;
  PolynomialMap<3> geometry_, motion_;
};

}  // namespace ricochet
