#pragma once

#include <vector>

#include "ricochet/fem/polynomial_shape.hpp"

/// @file Areas of parts of a facet that is moved by a displacement.
namespace ricochet {

/// Data of facets of one shape.
struct FacetShape {
  bool is_segment, is_triangle;
  PolynomialShape geometry, displacement;
  Points rule_points;
  Vector rule_weights;
  std::vector<int> border;  ///< displacement nodes on its border in cyclic order, or from end to end of a segment
  Points border_points;     ///< their reference coordinates
};
[[nodiscard]] FacetShape make_facet_shape(CellShape shape, int geometry_degree, int displacement_degree,
                                          bool axisymmetric);

/// Integrates |∂(X + u)/∂ξ| dξ over parts of one facet: an area, in 2D a length, in
/// axisymmetric bodies that of the ring.
class FacetArea {
 public:
  using Places = PolynomialMap<3>::NodePositions;
  /// Keeps a reference to the shape. `positions`: X at the nodes of the geometry; `motions`: u at
  /// the nodes of the displacement.
  FacetArea(const FacetShape& shape, const Places& positions, const Places& motions, bool axisymmetric);

  [[nodiscard]] double whole() const;
  /// Area between two reference coordinates of a segment.
  [[nodiscard]] double segment(double from, double to) const;
  /// Area between three points of the reference facet; negative in clockwise order.
  [[nodiscard]] double triangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) const;

 private:
  [[nodiscard]] double density(const double* point) const;

  const FacetShape& shape_;
  bool axisymmetric_;
  PolynomialMap<3> geometry_, motion_;
};

}  // namespace ricochet
