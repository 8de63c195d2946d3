#include "ricochet/linear_algebra/largest_eigenvalue.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ricochet {
namespace {

EigenvalueBounds bounds_of(const Vector& spectrum) {
  return bound_largest_eigenvalue(spectrum.size(), [&](const Vector& x, Vector& y) { y = spectrum.cwiseProduct(x); });
}

TEST(LargestEigenvalue, IsBoundedOnSpectraOfEveryKind) {
  const Index n = 5000;
  const Vector even = Vector::LinSpaced(n, 0.0, 7.0);
  Vector gap = even;
  gap[n - 1] = 70.0;
  Vector dense_top = even;  // the slowest for Lanczos' method: many eigenvalues at the top
  for (Index i = 0; i < n; ++i) dense_top[i] = 7.0 * std::sin(1.5707963267948966 * double(i) / (n - 1));
  Vector powers(n);
  for (Index i = 0; i < n; ++i) powers[i] = std::pow(0.99, double(i));
  for (const Vector& spectrum : {even, gap, dense_top, powers, Vector(Vector::Ones(n)), Vector(1e9 * even),
                                 Vector(1e-9 * gap), Vector(1e6 * dense_top)}) {
    const EigenvalueBounds found = bounds_of(spectrum);
    const double exact = spectrum.maxCoeff();
    EXPECT_LE(found.lower, exact * (1.0 + 1e-13));
    EXPECT_GE(found.upper, exact);
    EXPECT_LE(found.upper, 1.0205 * exact);
    EXPECT_LE(found.products, 100);
  }
}

TEST(LargestEigenvalue, OfSmallOperators) {
  EXPECT_EQ(bound_largest_eigenvalue(0, [](const Vector&, Vector&) {}).upper, 0.0);
  for (Index n = 1; n < 40; ++n) {
    const Vector spectrum = Vector::LinSpaced(n, 1.0, 3.0);
    const EigenvalueBounds found = bounds_of(spectrum);
    EXPECT_NEAR(found.lower, 3.0, 1e-12) << n;
    EXPECT_GE(found.upper, 3.0) << n;
  }
}

TEST(LargestEigenvalue, ScalesByPowersOfTwoToTheBit) {
  const Vector spectrum = Vector::LinSpaced(300, 1.0, 3.0);
  for (const int exponent : {-41, 1, 30}) {
    EXPECT_EQ(bounds_of(std::ldexp(1.0, exponent) * spectrum).upper, std::ldexp(bounds_of(spectrum).upper, exponent));
  }
}

/// An isolated eigenvalue is found from a random guess, a shifted one from its last vector, and no value exceeds the
/// spectrum. Inexact products leave their errors.
TEST(LargestEigenvalue, IsFollowedFromAGuess) {
  const Index n = 2000;
  Vector spectrum = Vector::LinSpaced(n, 0.0, 7.0);
  const auto improve = [&](Vector& guess, double error) {
    return improve_largest_eigenvalue(
        [&](const Vector& x, Vector& y) {
          y = spectrum.cwiseProduct(x);
          for (Index i = 0; i < n; ++i) y[i] += error * (i % 2 == 0 ? x.norm() : -x.norm()) / std::sqrt(n);
        },
        8, guess);
  };
  Vector guess(n);
  for (Index i = 0; i < n; ++i) guess[i] = std::sin(1.0 + 3.7 * double(i * i % 1009));
  spectrum[17] = 10.0;
  const double first = improve(guess, 0.0);
  EXPECT_NEAR(first, 10.0, 0.1);
  EXPECT_LE(first, 10.0 * (1.0 + 1e-13));
  EXPECT_NEAR(guess.norm(), 1.0, 1e-12);
  EXPECT_GT(std::abs(guess[17]), 0.9);
  spectrum[17] = 10.3;
  EXPECT_NEAR(improve(guess, 0.0), 10.3, 1e-3);
  EXPECT_NEAR(improve(guess, 1e-6), 10.3, 1e-4);
  spectrum *= 1e-12;  // of any size
  EXPECT_NEAR(improve(guess, 0.0), 10.3e-12, 1e-16);
  Vector one = Vector::Unit(n, 17);  // an eigenvector spans an invariant space
  EXPECT_NEAR(improve(one, 0.0), 10.3e-12, 1e-24);
}

TEST(LargestEigenvalue, OfNothingIsZero) { EXPECT_EQ(bounds_of(Vector::Zero(10)).upper, 0.0); }

}  // namespace
}  // namespace ricochet
