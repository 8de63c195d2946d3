#include "ricochet/scheme/reduced/energy_secant.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ricochet {
namespace {

/// Positions respond to σ at once: the balance requires c + slope σ. Returns the number of iterations to its σ.
int rounds_to_balance(double c, double slope, double tolerance) {
  EnergySecant secant;
  secant.start();
  for (int round = 1; round <= 100; ++round) {
    const double asked = c + slope * secant.value();
    const double lacking = asked - secant.value();
    if (std::abs(lacking) <= tolerance) return round;
    secant.choose(asked, lacking, 0.0, true);
  }
  return 1000;
}

TEST(EnergySecant, FindsABalanceThatIsLinearInSigmaInThreeRounds) {
  for (const double slope : {0.0, 0.3, -0.9, -3.0, 0.75, 0.99}) {
    EXPECT_LE(rounds_to_balance(0.01, slope, 1e-14), 4) << slope;
    EXPECT_GE(rounds_to_balance(0.01, slope, 1e-14), 2) << slope;
  }
}

TEST(EnergySecant, WaitsUntilPlacesHaveSettledWhereTheWorkHardlyAnswers) {
  EnergySecant secant;
  secant.start();
  EXPECT_FALSE(secant.choose(0.01, 1.0, 0.0, false));  // the slope is still unknown
  EXPECT_FALSE(secant.is_weak());
  EXPECT_TRUE(secant.choose(0.0195, 1.0, 0.0, false));  // 0.95 of the change is achieved
  EXPECT_TRUE(secant.is_weak());
  const double kept = secant.value();
  EXPECT_FALSE(secant.choose(0.5, 0.5, 0.0, false));
  EXPECT_FALSE(secant.choose(0.5, 0.5, 0.0, false));
  EXPECT_EQ(secant.value(), kept);
  EXPECT_TRUE(secant.choose(0.3, 0.3, 0.0, false));
  EXPECT_NE(secant.value(), kept);
}

TEST(EnergySecant, GivesUpWhereChangesBringNothingAndStaysWithinStrains) {
  EnergySecant secant;
  secant.start();
  int changes = 0;
  while (!secant.is_settled() && changes < 100) {
    secant.choose(1e3 + 0.9 * secant.value() + 0.05 * (changes % 2), 1.0, 0.0, true);
    EXPECT_LE(std::abs(secant.value()), 1.0);
    ++changes;
  }
  EXPECT_LT(changes, 20);
  const double last = secant.value();
  EXPECT_FALSE(secant.choose(-0.5, 1.0, 0.0, true));
  EXPECT_EQ(secant.value(), last);
  secant.start();
  EXPECT_EQ(secant.value(), 0.0);
  EXPECT_FALSE(secant.is_settled());
}

/// Rounding of the required value would give an arbitrary slope.
TEST(EnergySecant, KeepsTheSlopeThatItHasWhereTheRestIsRounding) {
  EnergySecant secant;
  secant.start();
  const auto asked_for = [](double sigma) { return 0.01 + 0.5 * sigma; };  // σ = 0.02
  secant.choose(asked_for(0.0), 1e-2, 1e-12, true);
  secant.choose(asked_for(secant.value()), 5e-3, 1e-12, true);
  EXPECT_NEAR(secant.value(), 0.02, 1e-15);
  secant.choose(secant.value() + 1e-16, 1e-16, 1e-12, true);
  secant.choose(secant.value() - 3e-16, 3e-16, 1e-12, true);
  EXPECT_NEAR(secant.value(), 0.02, 1e-15);
}

}  // namespace
}  // namespace ricochet
