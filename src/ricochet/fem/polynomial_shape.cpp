#include "ricochet/fem/polynomial_shape.hpp"

#include <Eigen/LU>

namespace ricochet {

namespace {

double power(double x, int exponent) { return exponent == 0 ? 1.0 : exponent == 1 ? x : x * x; }

}  // namespace

/// Computes the coefficients of each shape function, which is 1 at its node, in the monomials of their space.
PolynomialShape::PolynomialShape(CellShape shape, int degree) : dimension_(dimension(shape)) {
  for (int j = 0; j <= (dimension_ == 2 ? degree : 0); ++j) {
    for (int i = 0; i <= (is_simplex(shape) ? degree - j : degree); ++i, ++terms_) {
      powers_[terms_][0] = i;
      powers_[terms_][1] = j;
    }
  }
  const Points& nodes = ReferenceElement::get(shape, degree).nodes();
  Matrix at_nodes(terms_, nodes.cols());
  for (Index k = 0; k < nodes.cols(); ++k) monomials(nodes.col(k).data(), at_nodes.col(k).data());
  coefficients_ = at_nodes.inverse();
}

void PolynomialShape::monomials(const double* point, double* terms) const {
  for (int t = 0; t < terms_; ++t)
    terms[t] = power(point[0], powers_[t][0]) * (dimension_ == 2 ? power(point[1], powers_[t][1]) : 1.0);
}

/// The product has few entries and is written out, since Eigen's is optimized for larger ones.
void PolynomialShape::values(const double* point, double* values) const {
  double terms[most_nodes];
  monomials(point, terms);
  const auto count = int(coefficients_.rows());
  const double* coefficient = coefficients_.data();
  for (int i = 0; i < count; ++i) values[i] = 0.0;
  for (int t = 0; t < terms_; ++t) {
    for (int i = 0; i < count; ++i) values[i] += *coefficient++ * terms[t];
  }
}

template <int components>
PolynomialMap<components>::PolynomialMap(const PolynomialShape& shape, const NodePositions& positions)
    : shape_(shape), origin_(positions.col(0)) {
  for (int t = 0; t < shape.terms_; ++t) {
    At& sum = coefficients_[std::size_t(t)];
    sum.setZero();
    for (Index k = 1; k < shape.node_count(); ++k) sum += shape.coefficients_(k, t) * (positions.col(k) - origin_);
  }
}

template <int components>
auto PolynomialMap<components>::evaluate(const double* point) const -> Evaluation {
  const double x = point[0], y = shape_.dimension_ == 2 ? point[1] : 0.0;
  const double of_x[3] = {1.0, x, x * x}, of_y[3] = {1.0, y, y * y};
  const double slope_x[3] = {0.0, 1.0, 2.0 * x}, slope_y[3] = {0.0, 1.0, 2.0 * y};
  Evaluation result{origin_, {At::Zero(), At::Zero()}};
  for (int t = 0; t < shape_.terms_; ++t) {
    const int i = shape_.powers_[t][0], j = shape_.powers_[t][1];
    const At& coefficient = coefficients_[std::size_t(t)];
    result.at += of_x[i] * of_y[j] * coefficient;
    result.slopes[0] += slope_x[i] * of_y[j] * coefficient;
    result.slopes[1] += of_x[i] * slope_y[j] * coefficient;
  }
  return result;
}

template class PolynomialMap<2>;
template class PolynomialMap<3>;

}  // namespace ricochet
