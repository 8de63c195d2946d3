#include "ricochet/linear_algebra/anderson_acceleration.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <vector>

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

/// As many rounds after a change of the map as at the start, and one for the change itself: newer changes of the
/// residual replace those of the former map that they span.
TEST_F(ExpandingMap, IsSolvedAfterAChange) {
  AndersonAcceleration acceleration(12);
  Vector x = Vector::Zero(6);
  for (int round = 0; round < 6; ++round) acceleration.advance(x, image(x), x);
  slopes_ << 0.4, 2.0, -1.5, -0.7, 0.8, -4.0;
  for (int round = 0; round < 9; ++round) acceleration.advance(x, image(x), x);
  EXPECT_LE(residual(x), 1e-9);
}

TEST_F(ExpandingMap, GoesOnPlainlyAfterNumbersThatAreNotFinite) {
  AndersonAcceleration acceleration(12);
  Vector x = Vector::Zero(6), next;
  for (int round = 0; round < 3; ++round) acceleration.advance(x, image(x), x);
  acceleration.advance(x, Vector::Constant(6, std::nan("")), next);
  for (int round = 0; round < 8; ++round) acceleration.advance(x, image(x), x);
  EXPECT_LE(residual(x), 1e-9);
}

/// A map with many unknowns that is not linear.
class CurvedMap : public testing::Test {
 protected:
  static constexpr Index size = 700;
  [[nodiscard]] static Vector image(const Vector& x) {
    Vector result(size);
    for (Index i = 0; i < size; ++i)
      result[i] = std::cos(double(i)) + (0.9 - 1.8 * double(i * 37 % size) / double(size)) * std::sin(x[i]);
    return result;
  }
};

/// The combination is that of the least-squares problem solved anew, also after columns have come and gone for long.
/// Its condition is below 10 here, so that both are rounded to some 10 times the precision of x.
TEST_F(CurvedMap, IsCombinedByLeastSquares) {
  constexpr Index depth = 7;
  AndersonAcceleration acceleration{int(depth)};
  std::vector<Vector> points, residuals, images;
  Vector x = Vector::Zero(size);
  for (int round = 0; round < 40; ++round) {
    const Vector at = x;
    images.push_back(image(at));
    residuals.push_back(images.back() - at);
    acceleration.advance(at, images.back(), x);
    const Index count = std::min(depth, Index(images.size()) - 1);
    Vector expected = images.back();
    if (count > 0) {
      Matrix changes(size, count), image_changes(size, count);
      for (Index k = 0; k < count; ++k) {
        const std::size_t newer = images.size() - 1 - std::size_t(k);
        changes.col(k) = residuals[newer] - residuals[newer - 1];
        image_changes.col(k) = (images[newer] - images[newer - 1]) / changes.col(k).norm();
        changes.col(k).normalize();
      }
      expected -= image_changes * changes.colPivHouseholderQr().solve(residuals.back());
    }
    EXPECT_LE((x - expected).norm(), 1e-13 * x.norm()) << round;
  }
}

/// The first of two ranks, if the second one has none of the entries that are counted.
class FirstOfTwo final : public Ranks {
 public:
  [[nodiscard]] int size() const override { return 2; }
  void reduce(std::span<double>, std::span<const Reduction>) const override { ++reductions; }
  mutable long reductions = 0;
};

/// Entries that another rank counts do not influence the combination, and the products of a point are summed together:
/// one by one they would take up to 80 exchanges.
TEST_F(CurvedMap, IsCombinedOverRanksInFewExchanges) {
  const FirstOfTwo ranks;
  AndersonAcceleration whole(8), distributed(8);
  Vector is_counted = Vector::Ones(size + 300);
  is_counted.tail(300).setZero();
  distributed.distribute(ranks, is_counted);
  Vector x = Vector::Zero(size), with_copies = Vector::Zero(size + 300);
  for (int round = 0; round < 20; ++round) {
    whole.advance(x, image(x), x);
    const Vector own = image(with_copies.head(size));
    Vector all(size + 300);
    all << own, own.tail(300);
    ranks.reductions = 0;
    distributed.advance(with_copies, all, with_copies);
    EXPECT_LE(ranks.reductions, 4);
    EXPECT_LE((with_copies.head(size) - x).norm(), 1e-13 * x.norm()) << round;
    EXPECT_EQ(with_copies.segment(size - 300, 300), with_copies.tail(300)) << round;
  }
}

}  // namespace
}  // namespace ricochet
