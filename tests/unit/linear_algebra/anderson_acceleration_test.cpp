#include "ricochet/linear_algebra/anderson_acceleration.hpp"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

/// F(x) = A x + b with eigenvalues on both sides of the unit circle.
class ExpandingMap : public testing::Test {
 protected:
  ExpandingMap() : slopes_(6), offset_(6) {
    slopes_ << -3.0, -0.5, 0.0, 0.3, 0.9, 2.5;
    offset_ << 1.0, -2.0, 3.0, 0.5, -1.0, 2.0;
  }
  [[nodiscard]] Vector image(const Vector& x) const { return slopes_.cwiseProduct(x) + offset_; }
  [[nodiscard]] double residual(const Vector& x) const { return (image(x) - x).norm(); }

  Vector slopes_, offset_;
};

/// Like GMRES it needs a step per eigenvalue, while plain iterations diverge.
TEST_F(ExpandingMap, IsSolvedInAsManyRoundsAsItHasEigenvalues) {
  AndersonAcceleration acceleration(12);
  Vector x = Vector::Zero(6), plain = x;
  for (int round = 0; round < 7; ++round) {
    acceleration.advance(x, image(x), x);
    plain = image(plain);
  }
  EXPECT_LE(residual(x), 1e-9);
  EXPECT_GT(residual(plain), 1e3);
}

/// Beyond its depth it discards iterates, and continues.
TEST_F(ExpandingMap, IsSolvedWithLessMemoryAlso) {
  AndersonAcceleration acceleration(4);
  Vector x = Vector::Zero(6);
  for (int round = 0; round < 60; ++round) acceleration.advance(x, image(x), x);
  EXPECT_LE(residual(x), 1e-9);
}

/// At the solution the iterate stays: changes of rounding size do not move it.
TEST_F(ExpandingMap, StaysWhereItIsSolved) {
  AndersonAcceleration acceleration(12);
  Vector x = offset_.cwiseQuotient(Vector::Ones(6) - slopes_);
  const Vector solution = x;
  for (int round = 0; round < 20; ++round) acceleration.advance(x, image(x), x);
  EXPECT_LE((x - solution).norm(), 1e-12 * solution.norm());
}

TEST_F(ExpandingMap, BeginsWithThePlainRoundAfterARestart) {
  AndersonAcceleration acceleration(12);
  Vector x = Vector::Ones(6);
  for (int round = 0; round < 3; ++round) acceleration.advance(x, image(x), x);
  acceleration.restart();
  Vector next;
  acceleration.advance(x, image(x), next);
  EXPECT_EQ(next, image(x));
}

}  // namespace
}  // namespace ricochet
