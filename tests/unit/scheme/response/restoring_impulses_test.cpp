#include "ricochet/scheme/response/restoring_impulses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/errors.hpp"

/// @file p_i (a_i + ½(Wp)_i) = c_i with p > 0, compared with closed forms and with the equation itself.
namespace ricochet::test_support {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

/// Positive root of the single equation ½ w p² + a p = c, without cancellation.
double root(double w, double a, double c) {
  const double s = std::sqrt(a * a + 2.0 * w * c);
  return a > 0.0 ? 2.0 * c / (a + s) : (s - a) / w;
}

/// A symmetric positive definite matrix whose coupling decays with distance, as in an elastic body.
Matrix coupled(Index size) {
  Matrix w(size, size);
  for (Index i = 0; i < size; ++i) {
    for (Index j = 0; j < size; ++j) w(i, j) = 3.0 * std::exp(-0.5 * double(std::abs(i - j)));
  }
  return w;
}

/// Largest |p_i (a_i + ½(Wp)_i) − c_i|, relative to the terms of the sum.
double largest_residual(const Matrix& w, const Vector& a, const Vector& c, const Vector& p) {
  const Vector residual = p.cwiseProduct(a + 0.5 * (w * p)) - c;
  const Vector terms = p.cwiseProduct(a.cwiseAbs() + 0.5 * (w.cwiseAbs() * p)) + c;
  return residual.cwiseAbs().cwiseQuotient(terms).maxCoeff();
}

TEST(RestoringImpulses, OfOnePointAreTheRootOfAQuadraticEquation) {
  for (const double w : {1e-3, 2.0, 5e4}) {
    for (const double a : {-4.0, -1e-3, 0.0, 1e-3, 7.0}) {
      for (const double c : {1e-12, 0.3, 1e5}) {
        const Vector p = restoring_impulses(Matrix::Constant(1, 1, w), Vector::Constant(1, a), Vector::Constant(1, c));
        // If a is large relative to the root, c alone determines p, to the rounding of the terms.
        const double condition = (std::abs(a) + w * p[0]) / std::abs(a + w * p[0]);
        EXPECT_NEAR(p[0], root(w, a, c), 64.0 * rounding * condition * p[0]) << w << " " << a << " " << c;
      }
    }
  }
}

TEST(RestoringImpulses, OfPointsThatDoNotFeelEachOtherAreThoseOfEach) {
  const Vector diagonal{{0.5, 3.0, 40.0}}, a{{-2.0, 0.0, 5.0}}, c{{0.1, 4.0, 0.02}};
  const Vector p = restoring_impulses(Matrix(diagonal.asDiagonal()), a, c);
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(p[i], root(diagonal[i], a[i], c[i]), 64.0 * rounding * p[i]) << i;
}

TEST(RestoringImpulses, SolveTheEquationOfManyPoints) {
  constexpr Index size = 20;
  const Matrix w = coupled(size);
  Vector a(size), c(size);
  for (Index i = 0; i < size; ++i) {
    const auto x = double(i);
    a[i] = 3.0 * std::sin(1.7 * x) - 1.0;  // some approach, others separate
    c[i] = std::pow(10.0, -6.0 + std::fmod(2.3 * x, 6.0));
  }
  const Vector p = restoring_impulses(w, a, c);
  EXPECT_GT(p.minCoeff(), 0.0);
  EXPECT_LE(largest_residual(w, a, c, p), 1e-12) << "what is good enough where no step makes it smaller";
  // Another order gives the same impulses: the minimum is unique.
  const Vector turned = restoring_impulses(w.reverse(), a.reverse(), c.reverse());
  EXPECT_LE((turned.reverse() - p).cwiseQuotient(p).lpNorm<Eigen::Infinity>(), 1e-9);
}

/// a → αa, W → βW and c → (α²/β)c give (α/β)p; to the last bit if α and β are powers of 4.
TEST(RestoringImpulses, DoNotDependOnUnits) {
  const Matrix w = coupled(6);
  const Vector a{{-1.0, 0.5, -2.0, 0.1, 0.0, 3.0}}, c{{0.3, 1e-4, 2.0, 0.7, 1e-9, 0.05}};
  const Vector p = restoring_impulses(w, a, c);
  for (const int exponent : {-60, -2, 40}) {
    const double alpha = std::ldexp(1.0, exponent), beta = std::ldexp(1.0, 2 * exponent + 4);
    const Vector scaled = restoring_impulses(beta * w, alpha * a, (alpha * alpha / beta) * c);
    EXPECT_EQ(scaled, Vector((alpha / beta) * p)) << exponent;
  }
}

/// Without energy to restore, only approaching points have an impulse, which turns a into −a.
TEST(RestoringImpulses, GoOverIntoThoseOfAnElasticCollision) {
  const Vector p =
      restoring_impulses(Matrix(Vector{{2.0, 5.0}}.asDiagonal()), Vector{{-3.0, 3.0}}, Vector::Constant(2, 1e-300));
  EXPECT_NEAR(p[0], 3.0, 1e-14);
  EXPECT_NEAR(p[1] * 3.0, 1e-300, 1e-314);
}

TEST(RestoringImpulses, SayWhereThereAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorKind::not_converged, {}, [&] {
    static_cast<void>(restoring_impulses(coupled(2), Vector{{nan, 1.0}}, Vector::Constant(2, 1.0)));
  });
}

}  // namespace
}  // namespace ricochet::test_support
