#include "ricochet/fem/cell_integration.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

// Degrees of quadrature, compared with a rule of a higher degree.

namespace ricochet {
namespace {

class CellIntegration : public testing::TestWithParam<CellShape> {
 protected:
  /// ∫ φφᵀ over a cell with these nodes of the geometry.
  static Matrix mass(CellShape shape, const Points& nodes, int geometry, int displacement, int quadrature_degree) {
    const BlockIntegration rule(shape, geometry, displacement, quadrature_degree);
    Matrix result = Matrix::Zero(rule.displacement.values.rows(), rule.displacement.values.rows());
    for (Index q = 0; q < rule.rule.weights.size(); ++q) {
      const Matrix map = nodes * rule.geometry.gradients[std::size_t(q)];
      const Vector values = rule.displacement.values.col(q);
      result += rule.rule.weights[q] * map.determinant() * values * values.transpose();
    }
    return result;
  }
};

/// The mass of a distorted cell, curved if its geometry is of degree 2, is integrated exactly.
TEST_P(CellIntegration, OfProductsOfShapeFunctionsIsExact) {
  std::mt19937 random(7);
  const auto number = [&random] { return 0.05 * (double(random()) / 2147483648.0 - 1.0); };
  for (const int geometry : {1, 2}) {
    for (const int displacement : {1, 2}) {
      Points nodes = ReferenceElement::get(GetParam(), geometry).nodes();
      for (double& coordinate : nodes.reshaped()) coordinate += number();
      const int degree = product_quadrature_degree(GetParam(), geometry, displacement);
      const Matrix found = mass(GetParam(), nodes, geometry, displacement, degree);
      const Matrix expected = mass(GetParam(), nodes, geometry, displacement, degree + 5);
      EXPECT_LT((found - expected).norm(), 1e-14 * expected.norm()) << geometry << displacement;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, CellIntegration, testing::ValuesIn(cell_shapes()),
                         [](const auto& instance) { return name(instance.param); });

}  // namespace
}  // namespace ricochet
