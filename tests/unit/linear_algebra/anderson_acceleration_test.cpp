#include "ricochet/linear_algebra/anderson_acceleration.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "ricochet/linear_algebra/qr_anderson_acceleration.hpp"

namespace ricochet {
namespace {

using Accelerations = testing::Types<AndersonAcceleration, QrAndersonAcceleration>;

/// F(x) = A x + b with eigenvalues on both sides of the unit circle.
class AffineMap {
 public:
  AffineMap() : slopes_(6), offset_(6) {
    slopes_ << -3.0, -0.5, 0.0, 0.3, 0.9, 2.5;
    offset_ << 1.0, -2.0, 3.0, 0.5, -1.0, 2.0;
  }
  [[nodiscard]] Vector image(const Vector& x) const { return slopes_.cwiseProduct(x) + offset_; }
  [[nodiscard]] double residual(const Vector& x) const { return (image(x) - x).norm(); }
  [[nodiscard]] Vector solution() const { return offset_.cwiseQuotient(Vector::Ones(6) - slopes_); }
  void change() { slopes_ << 0.4, 2.0, -1.5, -0.7, 0.8, -4.0; }

 private:
  Vector slopes_, offset_;
};

template <class Acceleration>
class ExpandingMap : public testing::Test {
 protected:
  /// Continues for some iterations from x.
  void iterate(Acceleration& acceleration, int count, Vector& x) const {
    for (int iteration = 0; iteration < count; ++iteration) acceleration.advance(x, map_.image(x), x);
  }

  AffineMap map_;
};
TYPED_TEST_SUITE(ExpandingMap, Accelerations);

/// Like GMRES it needs an iteration per eigenvalue, while plain iterations diverge.
TYPED_TEST(ExpandingMap, IsSolvedInAsManyIterationsAsItHasEigenvalues) {
  TypeParam acceleration(12);
  Vector x = Vector::Zero(6), plain = x;
  this->iterate(acceleration, 7, x);
  for (int iteration = 0; iteration < 7; ++iteration) plain = this->map_.image(plain);
  EXPECT_LE(this->map_.residual(x), 1e-9);
  EXPECT_GT(this->map_.residual(plain), 1e3);
}

/// Beyond its depth it discards iterates, and continues.
TYPED_TEST(ExpandingMap, IsSolvedWithLessMemoryAlso) {
  TypeParam acceleration(4);
  Vector x = Vector::Zero(6);
  this->iterate(acceleration, 60, x);
  EXPECT_LE(this->map_.residual(x), 1e-9);
}

/// At the solution the iterate stays: changes of rounding size do not move it.
TYPED_TEST(ExpandingMap, StaysAtTheSolution) {
  TypeParam acceleration(12);
  const Vector solution = this->map_.solution();
  Vector x = solution;
  this->iterate(acceleration, 20, x);
  EXPECT_LE((x - solution).norm(), 1e-12 * solution.norm());
}

TYPED_TEST(ExpandingMap, BeginsWithThePlainIterationAfterARestart) {
  TypeParam acceleration(12);
  Vector x = Vector::Ones(6);
  this->iterate(acceleration, 3, x);
  acceleration.restart();
  Vector next;
  acceleration.advance(x, this->map_.image(x), next);
  EXPECT_EQ(next, this->map_.image(x));
}

/// It takes as many iterations after a change of the map as at the start, and one for the change itself: newer changes
/// of the residual replace those of the former map that they span.
TYPED_TEST(ExpandingMap, IsSolvedAfterAChange) {
  TypeParam acceleration(12);
  Vector x = Vector::Zero(6);
  this->iterate(acceleration, 6, x);
  this->map_.change();
  this->iterate(acceleration, 9, x);
  EXPECT_LE(this->map_.residual(x), 1e-9);
}

TEST(QrAndersonAcceleration, ContinuesPlainlyAfterNumbersThatAreNotFinite) {
  const AffineMap map;
  QrAndersonAcceleration acceleration(12);
  Vector x = Vector::Zero(6), next;
  for (int iteration = 0; iteration < 3; ++iteration) acceleration.advance(x, map.image(x), x);
  acceleration.advance(x, Vector::Constant(6, std::nan("")), next);
  for (int iteration = 0; iteration < 8; ++iteration) acceleration.advance(x, map.image(x), x);
  EXPECT_LE(map.residual(x), 1e-9);
}

/// A map with many unknowns that is not linear.
template <class Acceleration>
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
TYPED_TEST_SUITE(CurvedMap, Accelerations);

/// The combination is that of the least-squares problem solved anew, also after columns have come and gone for long.
/// Its condition is below 10 here, so that both are rounded to some 10 times the precision of x.
TYPED_TEST(CurvedMap, IsCombinedByLeastSquares) {
  constexpr Index depth = 7, size = TestFixture::size;
  TypeParam acceleration{int(depth)};
  std::vector<Vector> points, residuals, images;
  Vector x = Vector::Zero(size);
  for (int iteration = 0; iteration < 40; ++iteration) {
    const Vector at = x;
    images.push_back(this->image(at));
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
    EXPECT_LE((x - expected).norm(), 1e-13 * x.norm()) << iteration;
  }
}

/// The first of two ranks, if the second one has none of the entries that are counted.
class FirstOfTwo final : public Ranks {
 public:
  [[nodiscard]] int size() const override { return 2; }
  void reduce(std::span<double>, std::span<const Reduction>) const override {}
};

using CurvedMapOverRanks = CurvedMap<AndersonAcceleration>;

/// Entries that another rank counts do not influence the combination.
TEST_F(CurvedMapOverRanks, IsCombined) {
  const FirstOfTwo ranks;
  AndersonAcceleration whole(8), distributed(8);
  Vector is_counted = Vector::Ones(size + 300);
  is_counted.tail(300).setZero();
  distributed.distribute(ranks, is_counted);
  Vector x = Vector::Zero(size), with_copies = Vector::Zero(size + 300);
  for (int iteration = 0; iteration < 20; ++iteration) {
    whole.advance(x, image(x), x);
    const Vector own = image(with_copies.head(size));
    Vector all(size + 300);
    all << own, own.tail(300);
    distributed.advance(with_copies, all, with_copies);
    EXPECT_LE((with_copies.head(size) - x).norm(), 1e-13 * x.norm()) << iteration;
    EXPECT_EQ(with_copies.segment(size - 300, 300), with_copies.tail(300)) << iteration;
  }
}

}  // namespace
}  // namespace ricochet
