#pragma once

#include <array>

#include "ricochet/fem/reference_element.hpp"

/// @file Shape functions at arbitrary points of a cell, one point at a time.
namespace ricochet {

/// Shape functions of an element of degree 1 or 2 as polynomials, for evaluation at millions of points: a few products
/// per point instead of a new table (ReferenceElement::tabulate). Points may lie outside the cell.
class PolynomialShape {
 public:
  PolynomialShape(CellShape shape, int degree);

  static constexpr int most_nodes = 9;  ///< of a quadrilateral of degree 2
  [[nodiscard]] Index node_count() const { return coefficients_.rows(); }
  /// Computes one value per node; `point` has one or two coordinates, `values` space for all nodes.
  void values(const double* point, double* values) const;

 private:
  template <int components>
  friend class PolynomialMap;
  void monomials(const double* point, double* terms) const;

  int dimension_;
  int terms_ = 0;
  int powers_[most_nodes][2] = {};
  Matrix coefficients_;  ///< nodes × monomials
};

/// Map x(ξ) = Σ_k x_k φ_k(ξ) of one cell as polynomials, for evaluation at many of its points. With two components, as
/// a projection onto a plane, or with three.
template <int components>
class PolynomialMap {
 public:
  using At = Eigen::Matrix<double, components, 1>;
  /// x_k in the columns; components and nodes that a cell does not have are ignored.
  using NodePositions = Eigen::Matrix<double, components, PolynomialShape::most_nodes>;
  /// Keeps a reference to the shape.
  PolynomialMap(const PolynomialShape& shape, const NodePositions& positions);

  struct Evaluation {
    At at;                     ///< x
    std::array<At, 2> slopes;  ///< ∂x/∂ξ along the reference axes; zero along an axis that the cell does not have
  };
  /// `point` has one or two coordinates.
  [[nodiscard]] Evaluation evaluate(const double* point) const;

 private:
  const PolynomialShape& shape_;
  At origin_;  ///< the first node: the remainder is of the cell's size, and so is its rounding error
  std::array<At, PolynomialShape::most_nodes> coefficients_;  ///< per monomial
};

extern template class PolynomialMap<2>;
extern template class PolynomialMap<3>;

}  // namespace ricochet
