#include "ricochet/step/newton_progress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ricochet {
namespace {

using Advice = NewtonProgress::Advice;

constexpr double rounding = 1e-16, increment = 1.0;

/// Advice on corrections that shrink at a rate, until it is not to proceed.
std::vector<Advice> advice_at_rate(double rate, double price, double tolerance) {
  NewtonProgress progress;
  progress.start(rounding, price, tolerance);
  std::vector<Advice> all;
  double correction = increment;
  do {
    all.push_back(progress.assess(correction, increment));
    correction *= rate;
  } while (all.back() == Advice::proceed);
  return all;
}

/// At the rate θ the k-th correction leaves θᵏ/(1−θ).
TEST(NewtonProgress, EndsWhereTheRestIsBelowTheTolerance) {
  for (const double tolerance : {1e-4, 1e-8, 1e-13}) {
    const std::vector<Advice> advice = advice_at_rate(0.1, 10.0, tolerance);
    EXPECT_EQ(advice.back(), Advice::done);
    const auto count = double(advice.size());
    EXPECT_LE(std::pow(0.1, count) / 0.9, tolerance);
    EXPECT_GT(std::pow(0.1, count - 1.0) / 0.9, tolerance);
  }
}

/// From 0.7⁴ on, 10⁻⁸ needs some 47 iterations at the rate 0.7 and some 11 at that of a new factorization.
TEST(NewtonProgress, RenewsWhereThatTakesLessTimeThanTheIterationsItSaves) {
  const std::vector<Advice> cheap = advice_at_rate(0.7, 20.0, 1e-8);
  EXPECT_EQ(cheap.back(), Advice::renew);
  EXPECT_EQ(cheap.size(), 4U);  // the rate is the mean of three
  EXPECT_EQ(advice_at_rate(0.7, 50.0, 1e-8).back(), Advice::done);
  // Less accuracy needs fewer iterations.
  EXPECT_EQ(advice_at_rate(0.7, 20.0, 1e-3).back(), Advice::done);
  EXPECT_EQ(advice_at_rate(0.15, 0.0, 1e-8).back(), Advice::done) << "a new factorization is no better";
}

TEST(NewtonProgress, AcceleratesDecreasingCorrectionsNearTheSolution) {
  NewtonProgress progress;
  progress.start(rounding, 100.0, 1e-8);
  const auto wants = [&](double correction) {
    static_cast<void>(progress.assess(correction, increment));
    return progress.wants_acceleration();
  };
  EXPECT_FALSE(wants(1.0));
  EXPECT_FALSE(wants(0.5)) << "far from the solution";
  EXPECT_TRUE(wants(0.19));
  EXPECT_FALSE(wants(0.2)) << "it grows";
  EXPECT_TRUE(wants(0.1));
}

TEST(NewtonProgress, TightensOnce) {
  NewtonProgress progress;
  progress.start(rounding, 100.0, 1e-4);
  static_cast<void>(progress.assess(1.0, increment));
  EXPECT_EQ(progress.assess(1e-5, increment), Advice::done);
  EXPECT_FALSE(progress.is_tight());
  progress.tighten();
  EXPECT_EQ(progress.assess(1e-7, increment), Advice::proceed);
  EXPECT_TRUE(progress.is_tight());
  progress.start(rounding, 100.0);
  EXPECT_TRUE(progress.is_tight());
}

}  // namespace
}  // namespace ricochet
