#include "ricochet/fem/relaxation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

/// @file The rule of a viscoelastic branch over one step, h = 1.
namespace ricochet {
namespace {

using Strain = Eigen::Matrix3d;
using Index = Eigen::Index;

const std::vector<double>& ratios() {
  static const std::vector<double> all{1e-12, 1e-6, 1e-2, 0.3, 0.49, 0.51, 1.0, 3.0, 20.0, 1e3, 1e8};
  return all;
}

Strain some(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> random(-1.0, 1.0);
  Strain result;
  for (double& each : result.reshaped()) each = random(generator);
  return result + result.transpose();
}

struct Branch {
  Strain start = some(1), end = some(2), internal = some(3);
  [[nodiscard]] Strain middle() const { return 0.5 * (start + end); }
};

/// Half of the derivative of start_energy() by the strain; differences of a quadratic function are exact.
Strain start_stress(const RelaxationRule& rule, const Strain& strain, const Strain& internal, const Strain& end) {
  Strain result;
  for (Index i = 0; i < 9; ++i) {
    Strain more = strain, less = strain;
    more.reshaped()[i] += 1.0;
    less.reshaped()[i] -= 1.0;
    result.reshaped()[i] = (rule.start_energy(more, internal, end) - rule.start_energy(less, internal, end)) / 4.0;
  }
  return result;
}

TEST(Relaxation, TheWorkOfTheMeanIsStoredAndDissipated) {
  for (const double jump : {0.0, 1.0}) {
    const Branch branch;
    const Strain middle = branch.middle() + 0.5 * jump * some(4), far = jump * some(4);
    for (const double x : ratios()) {
      const RelaxationRule rule(x);
      const Strain mean = rule.mean(middle, branch.end, branch.internal);
      const Strain before = branch.start - branch.internal,
                   after = branch.end - rule.next(middle, branch.end, branch.internal);
      const double work = 2.0 * mean.cwiseProduct(branch.end - branch.start).sum();
      const double dissipated = rule.dissipation(branch.start, middle, branch.end, branch.internal);
      // 2(1−θ) is the derivative of the stress by the strain.
      const Strain none = Strain::Zero(), unit = Strain::Ones();
      const double kept = start_stress(rule, unit, none, none)(0, 0);
      EXPECT_GE(dissipated, 0.0);
      EXPECT_NEAR(
          work, after.squaredNorm() - before.squaredNorm() + dissipated + kept * far.cwiseProduct(after - before).sum(),
          1e-13 * (before.squaredNorm() + far.squaredNorm()))
          << x;
      // The strain at the start of the path.
      const Strain first = 2.0 * middle - branch.end;
      EXPECT_LT((start_stress(rule, first, branch.internal, after) - (2.0 * mean - after)).norm(), 1e-13) << x;
    }
  }
}

TEST(Relaxation, AStrainThatStaysRelaxesExponentially) {
  Branch branch;
  branch.end = branch.start;
  const Strain before = branch.start - branch.internal;
  for (const double x : ratios()) {
    const RelaxationRule rule(x);
    const Strain after = branch.end - rule.next(branch.middle(), branch.end, branch.internal);
    EXPECT_LT((after - std::exp(-x) * before).norm(), 1e-14 * before.norm()) << x;
    const Strain mean = rule.mean(branch.middle(), branch.end, branch.internal);
    EXPECT_LT((mean - (-std::expm1(-x) / x) * before).norm(), 1e-14 * before.norm()) << x;
    // ∫ (2/τ)|q|² dt
    EXPECT_NEAR(rule.dissipation(branch.start, branch.middle(), branch.end, branch.internal),
                -std::expm1(-2.0 * x) * before.squaredNorm(), 1e-14 * before.squaredNorm())
        << x;
  }
}

/// Compared with many short steps of the midpoint rule, whose error is of second order.
TEST(Relaxation, IsExactForAStrainThatGoesLinearly) {
  const Branch branch;
  for (const double x : {0.3, 3.0}) {
    const auto after = [&](int parts) {
      Strain internal = branch.internal;
      const double each = x / parts;
      for (int k = 0; k < parts; ++k) {
        const Strain strain = branch.start + (k + 0.5) / parts * (branch.end - branch.start);
        internal += each / (1.0 + 0.5 * each) * (strain - internal);
      }
      return internal;
    };
    const Strain exact = RelaxationRule(x).next(branch.middle(), branch.end, branch.internal);
    const double coarse = (after(1000) - exact).norm(), fine = (after(2000) - exact).norm();
    EXPECT_LT(fine, 1e-6);
    EXPECT_NEAR(coarse / fine, 4.0, 1e-2) << x;
  }
}

TEST(Relaxation, ItsLimitsAreASpringAndNothing) {
  const Branch branch;
  const RelaxationRule spring(1e-13), gone(1e13);
  EXPECT_LT((spring.mean(branch.middle(), branch.end, branch.internal) - (branch.middle() - branch.internal)).norm(),
            1e-12);
  EXPECT_NEAR(spring.stiffness(), 1.0, 1e-12);
  EXPECT_LT(gone.mean(branch.middle(), branch.end, branch.internal).norm(), 1e-12);
  EXPECT_LT((gone.next(branch.middle(), branch.end, branch.internal) - branch.end).norm(), 1e-12);
  EXPECT_LT(gone.stiffness(), 1e-12);
}

/// ∂q̄/∂Ē at fixed E₀.
TEST(Relaxation, TheStiffnessIsThatOfTheMean) {
  const Branch branch;
  for (const double x : ratios()) {
    const RelaxationRule rule(x);
    const Strain change = some(4), middle = branch.middle() + change, end = branch.end + 2.0 * change;
    const Strain difference =
        rule.mean(middle, end, branch.internal) - rule.mean(branch.middle(), branch.end, branch.internal);
    EXPECT_LT((difference - rule.stiffness() * change).norm(), 1e-13) << x;
  }
}

}  // namespace
}  // namespace ricochet
