#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>

#include "ricochet/mass/mass.hpp"
#include "support/box_mesh.hpp"
#include "support/convergence.hpp"
#include "support/mass_moments.hpp"

/// @file Total mass, centre of gravity and second moments, PᵀMP with P = (1, x, y[, z]), compared with exact values.
namespace ricochet::test_support::inertia_test {

std::vector<int> counts_of(int dimension, int count) { return std::vector<int>(std::size_t(dimension), count); }

/// Moments of the image of [0, 1]ᵈ under x ↦ A x + b, from those of the unit box: 1, ½, ⅓ or ¼.
Matrix exact_box_moments(const Matrix& a, const Vector& b) {
  const Index d = b.size();
  Matrix unit = Matrix::Constant(d + 1, d + 1, 0.25);
  unit.diagonal().setConstant(1.0 / 3.0);
  unit.row(0).setConstant(0.5);
  unit.col(0).setConstant(0.5);
  unit(0, 0) = 1.0;
  Matrix map = Matrix::Zero(d + 1, d + 1);
  map(0, 0) = 1.0;
  map.bottomLeftCorner(d, 1) = b;
  map.bottomRightCorner(d, d) = a;
  return test_material().density * a.determinant() * map * unit * map.transpose();
}

/// Moments of the disc or ball of radius one about a point.
Matrix exact_ball_moments(const Vector& centre) {
  const Index d = centre.size();
  const double volume = d == 2 ? M_PI : 4.0 * M_PI / 3.0;
  Matrix moments(d + 1, d + 1);
  moments(0, 0) = volume;
  moments.topRightCorner(1, d) = volume * centre.transpose();
  moments.bottomLeftCorner(d, 1) = volume * centre;
  moments.bottomRightCorner(d, d) = volume * (centre * centre.transpose() + Matrix::Identity(d, d) / double(d + 2));
  return test_material().density * moments;
}

double relative_error(const Matrix& found, const Matrix& exact) {
  return (found - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
}

SparseMatrix consistent_mass(const MeshedBody& test) { return assemble_scalar_mass(test.body, node_graph(test.space)); }

class Inertia : public testing::TestWithParam<ElementKind> {
 protected:
  std::unique_ptr<MeshedBody> make_body(const std::vector<int>& counts, const PointMap& map) const {
    return make_meshed_body(make_box_mesh({GetParam().shape, counts, GetParam().geometry_degree, 0.15, map}),
                            GetParam().displacement_degree);
  }
};

TEST_P(Inertia, OfAStraightBoxIsExact) {
  const int d = GetParam().dimension();
  Matrix a(3, 3);
  a << 1.3, 0.4, -0.1, -0.2, 0.9, 0.3, 0.15, -0.25, 1.1;
  const Matrix matrix = a.topLeftCorner(d, d);
  const Vector shift = Vector::LinSpaced(d, -2.0, 1.5);
  const auto test = make_body(counts_of(d, 3), affine_map(matrix, shift));
  const Matrix moments = mass_moments(consistent_mass(*test), test->space.nodes);
  EXPECT_LE(relative_error(moments, exact_box_moments(matrix, shift)), 1e-14);
}

/// Curved cells inside a body that is still the box: exact if the space contains x.
TEST_P(Inertia, OfABoxOfCurvedCellsIsExact) {
  const ElementKind& kind = GetParam();
  const int d = kind.dimension();
  const auto test = make_body(counts_of(d, 3), swirl_map(0.08));
  const Matrix moments = mass_moments(consistent_mass(*test), test->space.nodes);
  const Matrix exact = exact_box_moments(Matrix::Identity(d, d), Vector::Zero(d));
  if (kind.contains_affine()) {
    EXPECT_LE(relative_error(moments, exact), 1e-14);
  } else {  // the functions still sum to one; positions of the nodes are not exact moments
    EXPECT_NEAR(moments(0, 0), exact(0, 0), 1e-14 * exact(0, 0));
    EXPECT_LE(relative_error(moments, exact), 2e-2);
  }
}

/// A disc or ball: the error of straight geometry is of order 2; second-order geometry gives at least 3 (4 here, as the
/// nodes are smoothly spaced).
TEST_P(Inertia, OfADiscOrBallConverges) {
  const ElementKind& kind = GetParam();
  const int d = kind.dimension();
  const Vector centre = Vector::LinSpaced(d, 0.3, -0.2);
  const Matrix exact = exact_ball_moments(centre);
  Convergence errors(kind.label());
  for (const int count : d == 2 ? std::vector<int>{4, 8, 16, 32} : std::vector<int>{2, 4, 8}) {
    const auto test = make_body(counts_of(d, count), ball_map(centre));
    errors.add(relative_error(mass_moments(consistent_mass(*test), test->space.nodes), exact));
  }
  const double expected = kind.geometry_degree == 2 && kind.displacement_degree == 2 ? 3.0 : 2.0;
  EXPECT_GE(errors.last_order(), expected - 0.25);
}

/// Every construction compared with the consistent mass, on the same discrete body, with a side as contact boundary.
TEST_P(Inertia, IsKeptByEveryConstruction) {
  const ElementKind& kind = GetParam();
  const int d = kind.dimension();
  for (const bool bent : {false, true}) {
    const auto test = make_body(counts_of(d, d == 2 ? 6 : 4),
                                bent ? bend_map() : affine_map(Matrix::Identity(d, d), Vector::Ones(d)));
    const SparseMatrix consistent = consistent_mass(*test);
    const std::vector<Index> contact = facet_nodes(test->space, test->mesh.group("y0", d - 1).members);
    const MassInput input{&consistent, &test->space.nodes, contact};
    const Matrix wanted = mass_moments(consistent, test->space.nodes);

    EXPECT_EQ(relative_error(mass_moments(build_mass("consistent", input), test->space.nodes), wanted), 0.0);

    const SparseMatrix lumped = build_mass("lumped", input);
    EXPECT_EQ(lumped.nonZeros(), lumped.rows());
    EXPECT_GT(lumped.diagonal().minCoeff(), 0.0);
    const Matrix lumped_moments = mass_moments(lumped, test->space.nodes);
    EXPECT_NEAR(lumped_moments(0, 0), wanted(0, 0), 1e-12 * wanted(0, 0));
    if (kind.displacement_degree == 1) {
      EXPECT_LE((lumped_moments - wanted).row(0).cwiseAbs().maxCoeff(), 1e-12 * wanted.cwiseAbs().maxCoeff());
    }

    const SparseMatrix equivalent = build_mass("equivalent", input);
    EXPECT_LE(relative_error(mass_moments(equivalent, test->space.nodes), wanted), 1e-12);
    EXPECT_TRUE(is_positive_definite(equivalent, contact));
    EXPECT_TRUE(Matrix(equivalent) == Matrix(equivalent).transpose());
    for (const Index node : contact) EXPECT_EQ(equivalent.col(node).nonZeros(), 0);
  }
}

/// The nearest mass refuses coarse meshes; these are fine enough.
TEST_P(Inertia, IsKeptByTheNearestMass) {
  const ElementKind& kind = GetParam();
  const int d = kind.dimension();
  const auto test = make_body(counts_of(d, d == 2 ? 8 : 5), affine_map(Matrix::Identity(d, d), Vector::Ones(d)));
  const SparseMatrix consistent = consistent_mass(*test);
  const std::vector<Index> contact = facet_nodes(test->space, test->mesh.group("y0", d - 1).members);
  const SparseMatrix nearest = build_mass("equivalent-nearest", {&consistent, &test->space.nodes, contact});
  EXPECT_LE(relative_error(mass_moments(nearest, test->space.nodes), mass_moments(consistent, test->space.nodes)),
            1e-12);
  EXPECT_TRUE(is_positive_definite(nearest, contact));
  EXPECT_TRUE(Matrix(nearest) == Matrix(nearest).transpose());
  for (const Index node : contact) EXPECT_EQ(nearest.col(node).nonZeros(), 0);
}

INSTANTIATE_TEST_SUITE_P(Elements, Inertia, testing::ValuesIn(all_element_kinds()),
                         [](const auto& info) { return info.param.label(); });

}  // namespace ricochet::test_support::inertia_test
