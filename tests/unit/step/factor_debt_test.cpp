#include "ricochet/step/factor_debt.hpp"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

constexpr double price = 5.0;

TEST(FactorDebt, IsDueWhenStepsHaveTakenSoManyMoreIterationsThanTheBestOne) {
  Vector memory = Vector::Zero(FactorDebt::numbers);
  FactorDebt debt(memory);
  const auto allowed = int(NewtonThresholds().debt_in_prices * price);
  debt.add_step(4);
  for (int step = 0; step < allowed - 1; ++step) debt.add_step(6);  // one more than numbers vary by
  EXPECT_FALSE(debt.is_due(price));
  debt.add_step(6);
  EXPECT_TRUE(debt.is_due(price));
  EXPECT_FALSE(debt.is_due(2.0 * price));
  debt.clear();
  EXPECT_FALSE(debt.is_due(price));
}

TEST(FactorDebt, HasNoneWhileStepsTakeAboutTheSameNumber) {
  Vector memory = Vector::Zero(FactorDebt::numbers);
  FactorDebt debt(memory);
  for (int step = 0; step < 10'000; ++step) debt.add_step(20 + step % 2);
  EXPECT_FALSE(debt.is_due(price));
}

/// Its numbers are those of the state of a run, which a checkpoint contains.
TEST(FactorDebt, ContinuesFromItsNumbers) {
  Vector memory = Vector::Zero(FactorDebt::numbers), resumed = memory;
  FactorDebt debt(memory);
  debt.add_step(3);
  for (int step = 0; step < 5; ++step) debt.add_step(8);
  resumed = memory;
  FactorDebt other(resumed);
  debt.add_step(8);
  other.add_step(8);
  EXPECT_EQ(memory, resumed);
  EXPECT_TRUE(other.is_due(price));
}

}  // namespace
}  // namespace ricochet
