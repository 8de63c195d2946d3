#pragma once

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
  /// Per node: values, and derivatives along the axes, one axis after the other.
  void gradients(const double* point, double* values, double* gradients) const;

 private:
  void combine(const double* terms, double* result) const;
  void monomials(const double* point, double* terms) const;
  void derivatives(const double* point, int axis, double* terms) const;

  int dimension_;
  int terms_ = 0;
  int powers_[most_nodes][2] = {};
  Matrix coefficients_;  ///< nodes × monomials
};

}  // namespace ricochet
