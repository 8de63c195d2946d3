#include <gtest/gtest.h>

#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

// The acceleration reported by each scheme through impacts, which is zero at nodes without mass.

namespace ricochet::test_support::acceleration_test {

/// Expected V₁ − V₀ of a step, computed from the states at its two ends.
using VelocityChange = std::function<Vector(const StepEnd& before, const StepEnd& after)>;

/// Largest difference over all steps on dofs with mass, relative to the largest change.
double largest_difference(const std::string& mass, const std::string& time, const VelocityChange& expected) {
  CaseRun run(dragged_case(thrown_bodies()[0], mass, time, "friction = 0.3\n"));
  StepEnd before(run);
  double difference = 0.0, size = 0.0;
  run.run(
      [&] {
        const StepEnd after(run);
        const Vector change = expected(before, after);
        Vector wrong = after.velocity - before.velocity - change;
        for (const Index dof : run.problem().massless_dofs) {
          wrong[dof] = 0.0;
          EXPECT_EQ(after.acceleration[dof], 0.0);
        }
        difference = std::max(difference, wrong.lpNorm<Eigen::Infinity>());
        size = std::max(size, change.lpNorm<Eigen::Infinity>());
        before = after;
      },
      false);
  EXPECT_GT(size, 0.1);  // more than gravity causes in a step
  return difference / size;
}

constexpr double h = 0.01;

TEST(Acceleration, OfMidpointIsTheChangeOfVelocityInItsStep) {
  EXPECT_LT(largest_difference("consistent", "scheme = \"midpoint\"\n",
                               [](const StepEnd&, const StepEnd& after) { return Vector(h * after.acceleration); }),
            1e-12);
}

TEST(Acceleration, OfNewmarkIsWeightedByGamma) {
  const VelocityChange expected = [](const StepEnd& before, const StepEnd& after) {
    return Vector(h * (0.4 * before.acceleration + 0.6 * after.acceleration));
  };
  for (const char* mass : {"consistent", "equivalent"})
    EXPECT_LT(largest_difference(mass, "scheme = \"newmark\"\nbeta = 0.3025\ngamma = 0.6\n", expected), 1e-12);
}

/// Second differences of the displacement, whose velocities are (Uⁿ⁺¹ − Uⁿ⁻¹)/2h.
TEST(Acceleration, OfCentralDifferencesIsTheMeanOfBothEnds) {
  const VelocityChange expected = [](const StepEnd& before, const StepEnd& after) {
    return Vector(0.5 * h * (before.acceleration + after.acceleration));
  };
  EXPECT_LT(largest_difference("consistent", "scheme = \"klr-conserving\"\n", expected), 1e-11);
  EXPECT_LT(largest_difference("equivalent-lumped", "scheme = \"semi-explicit\"\n", expected), 1e-11);
}

}  // namespace ricochet::test_support::acceleration_test
