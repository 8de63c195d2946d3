#pragma once

#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/mesh/shapes/cell_shape.hpp"

/// @file Lagrange elements on reference cells and quadrature, from Basix (which only one source file includes).
namespace ricochet {

/// Shape functions and their gradients at a set of points.
struct Tabulation {
  Matrix values;                  ///< nodes × points
  std::vector<Matrix> gradients;  ///< per point: nodes × dimension, in reference coordinates
};

struct QuadratureRule {
  Points points;   ///< dimension × count, reference coordinates
  Vector weights;  ///< their sum is the measure of the reference cell
};

/// Lagrange element of degree 1 or 2 on a reference cell ([0,1]ⁿ or the unit simplex).
class ReferenceElement {
 public:
  /// Returns the single instance for a shape and degree.
  static const ReferenceElement& get(CellShape shape, int degree);

  [[nodiscard]] CellShape shape() const { return shape_; }
  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] int node_count() const { return int(nodes_.cols()); }
  /// Node positions, dimension × nodes.
  [[nodiscard]] const Points& nodes() const { return nodes_; }
  [[nodiscard]] Tabulation tabulate(const Points& points) const;

 private:
  ReferenceElement(CellShape shape, int degree);

  CellShape shape_;
  int degree_;
  Points nodes_;
};

/// Quadrature rule, exact for polynomials of the given degree (on tensor-product cells: of that degree per variable).
[[nodiscard]] QuadratureRule quadrature(CellShape shape, int degree);

/// Mean of the vertices of the reference cell.
[[nodiscard]] Vector reference_centre(CellShape shape);

}  // namespace ricochet
