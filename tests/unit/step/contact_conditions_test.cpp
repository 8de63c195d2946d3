#include "ricochet/step/contact_conditions.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file The order of the contact conditions of a stage.
namespace ricochet {
namespace {

/// Friction relative to obstacle velocities of an earlier step, or of none, would be wrong in silence.
TEST(ContactConditions, OfFrictionNeedTheVelocityOfObstaclesThatMove) {
  const auto time = test_support::time_of("newmark");
  const test_support::CaseRun moving(
      test_support::dragged_case(test_support::one_sided_block(), "consistent", time, "friction = 0.3\n"));
  const Vector zero = Vector::Zero(moving.problem().dof_count());
  Stage stage;
  require_no_penetration(moving.problem(), zero, 0.0, stage);
  EXPECT_THROW(require_friction(moving.problem(), zero, 1.0, stage), std::logic_error);
  evaluate_obstacle_velocity(moving.problem(), zero, {}, stage);
  require_friction(moving.problem(), zero, 1.0, stage);
  EXPECT_GT(stage.conditions.slip.offset.lpNorm<Eigen::Infinity>(), 0.1);
  EXPECT_THROW(require_friction(moving.problem(), zero, 1.0, stage), std::logic_error) << "that of an earlier step";

  const test_support::CaseRun at_rest(
      test_support::thrown_case(test_support::one_sided_block(), "consistent", time, "friction = 0.3\n"));
  Stage other;
  require_no_penetration(at_rest.problem(), zero, 0.0, other);
  require_friction(at_rest.problem(), zero, 1.0, other);
  EXPECT_EQ(other.conditions.slip.offset.lpNorm<Eigen::Infinity>(), 0.0);
}

}  // namespace
}  // namespace ricochet
