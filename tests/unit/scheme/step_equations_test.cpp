#include "ricochet/scheme/step_equations.hpp"

#include <gtest/gtest.h>

#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Stages of the schemes, compared with their formulas in the matrices of the problem.
namespace ricochet::test_support {
namespace {

class StepEquationsTest : public testing::Test {
 protected:
  CaseRun run_{dragged_case(one_sided_block(), "consistent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n",
                            "friction = 0.3\n")};
  const SemidiscreteProblem& problem_ = run_.problem();
  const Vector base_ = Vector::Random(problem_.dof_count());
  const Vector velocity_ = Vector::Random(problem_.dof_count());
  StepEquations equations_;
  Stage stage_;
};

/// b = L(t) − K base − C v.
TEST_F(StepEquationsTest, BalanceTheForcesAtTheBase) {
  constexpr double time = 0.37;
  Vector load, internal;
  problem_.loads.total(time, load);
  problem_.internal_force->evaluate(base_, internal);
  equations_.balance(problem_, time, base_, stage_);
  const double size = load.norm() + internal.norm();
  EXPECT_LE((stage_.right_hand_side.force - (load - internal)).norm(), 1e-15 * size);
  ASSERT_TRUE(problem_.has_damping());
  equations_.balance(problem_, time, base_, velocity_, stage_);
  const Vector damping = problem_.damping.matrix() * velocity_;
  EXPECT_GT(damping.norm(), 0.0);
  EXPECT_LE((stage_.right_hand_side.force - (load - internal - damping)).norm(), 1e-15 * (size + damping.norm()));
}

/// p = B_T v minus the obstacle's velocity, over the whole step: v = ΔU/h, and the plane drags along.
TEST_F(StepEquationsTest, TakeTheSlipOfTheWholeStep) {
  constexpr double h = 0.01;
  const Vector predicted = h * velocity_;
  ASSERT_TRUE(problem_.contact.has_friction());
  ASSERT_TRUE(problem_.has_moving_obstacles());
  stage_.rows = problem_.contact.rows;
  equations_.require_friction_over_step(problem_, run_.state(), predicted, h, stage_);
  Vector slip;
  problem_.contact.rows->tangential_motion(velocity_, slip);
  ObstacleMotion obstacle;
  problem_.obstacle_velocity(run_.state().displacement + 0.5 * predicted, 0.5 * h, h, obstacle);
  EXPECT_GT(obstacle.tangential.norm(), 0.0);
  EXPECT_LE((stage_.conditions.slip.offset - (slip - obstacle.tangential)).norm(), 1e-14 * slip.norm());
  EXPECT_EQ(stage_.conditions.slip.factor, 1.0 / h);
}

TEST(StepEquations, PrescribeWhatSupportsDo) {
  for (const SupportedCase& supported : moving_support_cases()) {
    CaseRun run(supported.text);
    const SemidiscreteProblem& problem = run.problem();
    ASSERT_GT(problem.supports.size(), 0);
    Vector wanted;
    problem.supports.values(0.2, wanted);
    StepEquations equations;
    Stage stage;
    equations.prescribe(
        problem, 0.2, [](Index dof, double value) { return value - double(dof); }, stage);
    for (Index i = 0; i < wanted.size(); ++i) {
      const Index dof = problem.supports.dofs()[std::size_t(i)];
      EXPECT_EQ(stage.right_hand_side.prescribed[i], wanted[i] - double(dof));
    }
    break;
  }
}

/// Dofs without inertia have no acceleration, and their velocity is the mean over the step.
TEST(StepEquations, LetMasslessDofsFollow) {
  CaseRun run(thrown_case(one_sided_block(), "equivalent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n"));
  const SemidiscreteProblem& problem = run.problem();
  ASSERT_FALSE(problem.massless_dofs.empty());
  State state = run.state();
  const Vector ones = Vector::Ones(problem.dof_count());
  state.velocity = state.acceleration = 7.0 * ones;
  follow_without_inertia(problem, ones, 0.5, state);
  for (Index dof = 0; dof < problem.dof_count(); ++dof) {
    const bool is_massless = problem.is_massless[std::size_t(dof)] != 0;
    EXPECT_EQ(state.velocity[dof], is_massless ? 2.0 : 7.0);
    EXPECT_EQ(state.acceleration[dof], is_massless ? 0.0 : 7.0);
  }
}

}  // namespace
}  // namespace ricochet::test_support
