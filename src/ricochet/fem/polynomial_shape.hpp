#pragma once

#include <array>

#include "ricochet/fem/reference_element.hpp"

/// @file Shape functions at any point of a cell, one point at a time.
namespace ricochet {

/// The shape functions of an element of degree 1 or 2 as polynomials, for those who ask at millions of points: some
/// products each, where a table (ReferenceElement::tabulate) has to be made. Points may lie outside of the cell.
class PolynomialShape {
 public:
  PolynomialShape(CellShape shape, int degree);

  static constexpr int most_nodes = 9;  ///< of a quadrilateral of degree 2
  [[nodiscard]] Index node_count() const { return coefficients_.rows(); }
  /// Per node; `point` has one or two coordinates, `values` room for all nodes.
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

/// x(ξ) = Σ_k x_k φ_k(ξ) of one cell, as polynomials: for those who ask where a cell is at many of its points. With two
/// components, seen in a plane, or with three.
template <int components>
class PolynomialMap {
 public:
  using At = Eigen::Matrix<double, components, 1>;
  /// x_k in the columns; components and nodes that a cell does not have count for nothing.
  using NodePlaces = Eigen::Matrix<double, components, PolynomialShape::most_nodes>;
  /// Keeps a reference to the shape.
  PolynomialMap(const PolynomialShape& shape, const NodePlaces& places);

  struct Place {
    At at;                     ///< x
    std::array<At, 2> slopes;  ///< ∂x/∂ξ along the axes; zero along one that the cell does not have
  };
  /// `point` has one or two coordinates.
  [[nodiscard]] Place evaluate(const double* point) const;

 private:
  const PolynomialShape& shape_;
  At origin_;  ///< the first node: what is left is of the cell's size, and so is its rounding
  std::array<At, PolynomialShape::most_nodes> coefficients_;  ///< per monomial
};

extern template class PolynomialMap<2>;
extern template class PolynomialMap<3>;

}  // namespace ricochet
