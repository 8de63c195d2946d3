#include "ricochet/solver/contact/contact_point.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "support/contact_problems.hpp"

namespace ricochet::test_support {
namespace {

ContactPoint make_point(Index size, double coefficient, double bound = 0.0) {
  ContactPoint point;
  point.size = size;
  point.coefficient = coefficient;
  point.bound = bound;
  return point;
}

PointVector vector(std::initializer_list<double> values) {
  PointVector result(static_cast<Index>(values.size()));
  std::ranges::copy(values, result.data());
  return result;
}

void expect_near(const PointVector& found, const PointVector& expected, double tolerance = 1e-14) {
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(), tolerance * (1.0 + expected.lpNorm<Eigen::Infinity>()))
      << "found " << found.transpose() << ", expected " << expected.transpose();
}

PaddedVector pad(const PointVector& rows) {
  PaddedVector result = PaddedVector::Zero();
  result.head(rows.size()) = rows;
  return result;
}

PointVector solve_point(const ContactPoint& point, const PointMatrix& w, const PointVector& q) {
  return ricochet::solve_point(point, make_point_operator(w), pad(q)).head(point.size);
}

TEST(ContactPoint, IsOpenWhereNothingPressesIt) {
  const PointMatrix w = Eigen::Matrix3d::Identity();
  EXPECT_EQ(solve_point(make_point(3, 0.5), w, vector({0.1, 1.0, -1.0})), vector({0.0, 0.0, 0.0}));
  EXPECT_EQ(solve_point(make_point(3, 0.5), w, vector({0.0, 1.0, -1.0})), vector({0.0, 0.0, 0.0}));
}

TEST(ContactPoint, IsFrictionlessWithoutTangentsOrWithoutCoefficient) {
  EXPECT_EQ(solve_point(make_point(1, 0.5), PointMatrix::Constant(1, 1, 4.0), vector({-2.0})), vector({0.5}));
  PointMatrix w(2, 2);
  w << 4.0, 1.0, 1.0, 3.0;
  EXPECT_EQ(solve_point(make_point(2, 0.0), w, vector({-2.0, 7.0})), vector({0.5, 0.0}));
}

TEST(ContactPoint, SticksAndSlipsInClosedFormInTwoDimensions) {
  PointMatrix w(2, 2);
  w << 2.0, 0.5, 0.5, 1.0;
  const ContactPoint point = make_point(2, 0.4);
  // W (1, 0.3) = (2.15, 0.8): stick, as 0.3 < 0.4.
  expect_near(solve_point(point, w, vector({-2.15, -0.8})), vector({1.0, 0.3}));
  // Slip: r_N = −q_N/(W_NN ± F W_NT), u_T opposite to ρ_T.
  expect_near(solve_point(point, w, vector({-2.2, -5.0})), vector({1.0, 0.4}));
  expect_near(solve_point(point, w, vector({-1.8, 5.0})), vector({1.0, -0.4}));
  // The limit between stick and slip, from both sides: ρ is continuous there.
  expect_near(solve_point(point, w, vector({-2.2, -0.9})), vector({1.0, 0.4}));
  expect_near(solve_point(point, w, vector({-2.2, -0.9 - 1e-13})), vector({1.0, 0.4}), 1e-12);
  expect_near(solve_point(point, w, vector({-2.2, -0.9 + 1e-13})), vector({1.0, 0.4}), 1e-12);
}

TEST(ContactPoint, SlipsAgainstTheSlipOfAnIsotropicPoint) {
  const PointMatrix w = PointMatrix(Eigen::Vector3d(2.0, 3.0, 3.0).asDiagonal());
  const PointVector rho = solve_point(make_point(3, 0.5), w, vector({-4.0, 9.0, -12.0}));
  expect_near(rho, vector({2.0, -0.6, 0.8}));
}

/// q is computed from a chosen ρ on the cone and a chosen κ, for W as oblique as a definite matrix can be.
TEST(ContactPoint, FindsTheSlipItWasMadeFrom) {
  std::mt19937 random(5);
  int sticking = 0;
  for (int k = 0; k < 2000; ++k) {
    SCOPED_TRACE(k);
    const PointMatrix w = random_operator(3, 4.0 * std::abs(uniform(random)), random);
    const double kappa = std::pow(10.0, 6.0 * uniform(random));
    const double angle = 4.0 * uniform(random);
    // Weak enough that r_N exists for every direction of slip.
    const double friction = 0.5 * std::abs(w(0, 0) / w.row(0).tail(2).norm());
    const PointVector rho = vector({1.0, friction * std::cos(angle), friction * std::sin(angle)});
    PointVector u = -kappa * rho;
    u[0] = 0.0;
    const PointVector q = u - w * rho;
    const PointVector found = solve_point(make_point(3, friction), w, q);
    const PointVector motion = w * found + q;
    // Compared up to the rounding of q: u and the cone.
    const double rounding = 1e-13 * (q.norm() + found.norm());
    EXPECT_NEAR(motion[0], 0.0, rounding);
    const PointVector slip = motion.tail(2);
    const double limit = friction * found[0];
    if (slip.norm() > rounding) {
      EXPECT_NEAR(found.tail(2).norm(), limit, 8e-15 * limit);
    } else {
      // A strong coefficient admits stick as well as slip; rare here.
      EXPECT_LE(found.tail(2).norm(), limit);
      ++sticking;
    }
    EXPECT_LE((slip + slip.norm() / found.tail(2).norm() * found.tail(2)).norm(), 4.0 * rounding);
    EXPECT_LT(slip.dot(found.tail(2)), rounding * found.norm());
  }
  EXPECT_LE(sticking, 20);
}

TEST(ContactPoint, SlipsWithTrescasBound) {
  PointMatrix w(2, 2);
  w << 2.0, 0.5, 0.5, 1.0;
  expect_near(solve_point(make_point(2, 0.0, 3.0), w, vector({-5.5, -20.0})), vector({2.0, 3.0}));
  expect_near(solve_point(make_point(2, 0.0, 3.0), w, vector({-5.0, -3.0})),
              PointVector(w.inverse() * vector({5.0, 3.0})));
  // Friction carries the point: r_N = 0 with u_N = 0.
  expect_near(solve_point(make_point(2, 0.0, 3.0), w, vector({-0.5, -20.0})), vector({0.0, 1.0}));
}

TEST(ContactPoint, SlipsWithTheLesserOfCoulombsFrictionAndTheBound) {
  PointMatrix w(2, 2);
  w << 2.0, 0.5, 0.5, 1.0;
  // r_N = 2, so F r_N is 4 above the bound of 3, and 1 below it.
  expect_near(solve_point(make_point(2, 2.0, 3.0), w, vector({-5.5, -20.0})), vector({2.0, 3.0}));
  expect_near(solve_point(make_point(2, 0.5, 3.0), w, vector({-4.5, -20.0})), vector({2.0, 1.0}));
  expect_near(solve_point(make_point(2, 2.0, 3.0), w, vector({-4.2, -1.2})),
              PointVector(w.inverse() * vector({4.2, 1.2})));
  // The normal reaction is too small for friction to carry the point: on the cone below the bound.
  const PointVector found = solve_point(make_point(2, 2.0, 3.0), w, vector({-0.5, -20.0}));
  EXPECT_NEAR(found[1], 2.0 * found[0], 1e-15);
  EXPECT_NEAR(2.0 * found[0] + 0.5 * found[1] - 0.5, 0.0, 1e-15);
}

TEST(ContactPoint, SlipsWhereTangentialComplianceIsMissing) {
  PointMatrix w = PointMatrix::Zero(3, 3);
  w(0, 0) = 2.0;
  expect_near(solve_point(make_point(3, 0.5), w, vector({-2.0, 3.0, -4.0})), vector({1.0, -0.3, 0.4}));
  expect_near(solve_point(make_point(3, 0.5), w, vector({-2.0, 0.0, 0.0})), vector({1.0, 0.0, 0.0}));
}

TEST(ContactPoint, AlartCurnierResidualIsZeroOnTheLawOnly) {
  const ContactPoint point = make_point(3, 0.5);
  const auto residual = [&](std::initializer_list<double> r, std::initializer_list<double> u) {
    return alart_curnier_residual(point, 1.0, pad(vector(r)), pad(vector(u)));
  };
  EXPECT_EQ(residual({0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}), 0.0);
  EXPECT_EQ(residual({2.0, 0.3, 0.4}, {0.0, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(residual({2.0, 0.6, 0.8}, {0.0, -6.0, -8.0}), 0.0, 1e-15);
  EXPECT_EQ(residual({0.0, 0.0, 0.0}, {-1.0, 2.0, 3.0}), 1.0);          // penetrates
  EXPECT_EQ(residual({2.0, 0.0, 0.0}, {1.0, 0.0, 0.0}), 1.0);           // pulls away under force
  EXPECT_EQ(residual({2.0, 0.3, 0.4}, {0.0, 0.01, 0.0}), 0.01);         // slips inside the cone
  EXPECT_NEAR(residual({2.0, 0.6, 0.8}, {0.0, 6.0, 8.0}), 2.0, 1e-15);  // friction along the slip
  EXPECT_NEAR(residual({2.0, 1.2, 1.6}, {0.0, 0.0, 0.0}), 1.0, 1e-15);  // beyond the cone
}

TEST(ContactPoint, NaturalMapIsZeroOnTheLawOnly) {
  ContactPoint point = make_point(3, 0.5);
  point.diagonal = 4.0;
  const auto map = [&](std::initializer_list<double> r, std::initializer_list<double> u) {
    return natural_map(point, pad(vector(r)), pad(vector(u)));
  };
  EXPECT_EQ(map({0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}).norm(), 0.0);
  EXPECT_EQ(map({2.0, 0.3, 0.4}, {0.0, 0.0, 0.0}).norm(), 0.0);
  EXPECT_NEAR(map({2.0, 0.6, 0.8}, {0.0, -6.0, -8.0}).norm(), 0.0, 1e-15);
  EXPECT_EQ(map({0.0, 0.0, 0.0}, {0.0, 2.0, 3.0}).norm(), 0.0);
  // Stick inside the cone: the residual is û/w alone.
  EXPECT_EQ(map({2.0, 0.3, 0.4}, {0.0, 0.04, 0.0}), PaddedVector(0.005, 0.01, 0.0));
  // A pull, a penetration, friction along the slip, a reaction beyond the cone.
  EXPECT_GT(map({2.0, 0.0, 0.0}, {1.0, 0.0, 0.0}).norm(), 0.1);
  EXPECT_EQ(map({0.0, 0.0, 0.0}, {-4.0, 0.0, 0.0}), PaddedVector(-1.0, 0.0, 0.0));
  EXPECT_GT(map({2.0, 0.6, 0.8}, {0.0, 6.0, 8.0}).norm(), 1.0);
  EXPECT_GT(map({2.0, 1.2, 1.6}, {0.0, 0.0, 0.0}).norm(), 0.1);
}

TEST(ContactPoint, ProjectionOnTheConeIsTheNearestPoint) {
  std::mt19937 random(11);
  for (int k = 0; k < 2000; ++k) {
    const double friction = 2.0 * std::abs(uniform(random));
    const PaddedVector r = uniform(3, random);
    const PaddedVector p = project_on_cone(friction, r);
    EXPECT_LE(p.tail<2>().norm(), friction * p[0] * (1.0 + 1e-15) + 1e-300);
    // r − p is in the polar cone and normal to p.
    const PaddedVector rest = r - p;
    EXPECT_NEAR(rest.dot(p), 0.0, 1e-15);
    EXPECT_LE(friction * rest.tail<2>().norm(), -rest[0] + 1e-15);
  }
}

}  // namespace
}  // namespace ricochet::test_support
