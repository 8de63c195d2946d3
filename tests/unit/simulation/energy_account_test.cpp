#include "ricochet/simulation/history/energy_account.hpp"

#include <gtest/gtest.h>

#include "ricochet/simulation/monitor/deepest_point.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Works of prescribed forces and motions: each part of the account compared with its formula.
namespace ricochet::test_support {
namespace {

class Account : public testing::Test {
 protected:
  Account() {
    const SemidiscreteProblem& problem = run_.problem();
    state_ = run_.state();
    const Index points = problem.contact.size();
    state_.forces.rows = problem.contact.rows;
    state_.forces.normal_reaction = Vector::Random(points).cwiseAbs();
    state_.forces.tangential_reaction = Vector::Random(points * (problem.dimension - 1));
    state_.forces.varying_load = Vector::Random(problem.dof_count());
    state_.forces.damping_force = Vector::Random(problem.dof_count());
    state_.obstacle_increment.normal = Vector::Random(points);
    state_.obstacle_increment.tangential = Vector::Random(points * (problem.dimension - 1));
    increment_ = Vector::Random(problem.dof_count());
  }

  // Midpoint's forces act over the whole step: the account counts those at its end once.
  CaseRun run_{thrown_case(one_sided_block(), "consistent", "scheme = \"midpoint\"\n", "friction = 0.3\n")};
  State state_;
  Vector increment_;
};

TEST_F(Account, HasEachWorkByItsFormula) {
  const SemidiscreteProblem& problem = run_.problem();
  EnergyAccount account(problem, run_.scheme(), run_.state());
  account.enter_step(increment_, state_);
  const StepForces& forces = state_.forces;
  Vector gap, slip;
  problem.contact.rows->normal_motion(increment_, gap);
  problem.contact.rows->tangential_motion(increment_, slip);
  const ObstacleMotion& obstacle = state_.obstacle_increment;
  const Works& works = account.works();
  const auto near = [](double found, double wanted) { EXPECT_NEAR(found, wanted, 1e-13 * (1.0 + std::abs(wanted))); };
  near(works.contact, forces.normal_reaction.dot(gap - obstacle.normal));
  near(works.friction, -forces.tangential_reaction.dot(slip - obstacle.tangential));
  near(works.obstacle,
       forces.normal_reaction.dot(obstacle.normal) - forces.tangential_reaction.dot(obstacle.tangential));
  near(works.load, forces.varying_load.dot(increment_));
  near(works.damping, -forces.damping_force.dot(increment_));
  // The works of the reactions sum to the work of their nodal forces: nothing is counted twice or left out.
  Vector nodal = Vector::Zero(problem.dof_count());
  problem.contact.rows->add_force(forces.normal_reaction, forces.tangential_reaction, nodal);
  near(works.contact + works.friction + works.obstacle, nodal.dot(increment_));
}

TEST_F(Account, GoesOnFromWhatWasSaved) {
  EnergyAccount account(run_.problem(), run_.scheme(), run_.state());
  account.enter_step(increment_, state_);
  Snapshot snapshot;
  account.persist(snapshot.saver("account"));
  EnergyAccount resumed(run_.problem(), run_.scheme(), state_, snapshot.loader("account"));
  account.enter_step(increment_, state_);
  resumed.enter_step(increment_, state_);
  EXPECT_EQ(resumed.works().sum(), account.works().sum());
  EXPECT_EQ(resumed.residual(resumed.energies(state_)), account.residual(account.energies(state_)));
}

/// Energies of a body in flight: ½ m v² and the potential of gravity.
TEST_F(Account, KnowsTheEnergyOfAFreeFlight) {
  const SemidiscreteProblem& problem = run_.problem();
  EnergyAccount account(problem, run_.scheme(), run_.state());
  const Energies energies = account.energies(run_.state());
  const State& state = run_.state();
  EXPECT_NEAR(energies.total(), total_energy(problem, state.displacement, state.velocity),
              1e-12 * size_of_energy_terms(problem, state.displacement, state.velocity));
  EXPECT_GT(energies.kinetic, 0.0);
}

TEST(DeepestPoint, KeepsTheWorstAndTheFirst) {
  DeepestPoint deepest;
  EXPECT_FALSE(deepest.found());
  deepest.enter(4, 0.1, 1.0, {1.0, 0.0, 0.0});
  deepest.enter(5, 0.3, 2.0, {2.0, 0.0, 0.0});
  deepest.enter(6, 0.2, 3.0, {3.0, 0.0, 0.0});
  Snapshot snapshot;
  snapshot.saver("deepest").numbers("", deepest);
  DeepestPoint again;
  snapshot.loader("deepest").numbers("", again);
  EXPECT_EQ(again.node, 5);
  EXPECT_EQ(again.depth, 0.3);
  EXPECT_EQ(again.time, 2.0);
  EXPECT_EQ(again.position[0], 2.0);
  EXPECT_EQ(again.first_time, 1.0);
}

}  // namespace
}  // namespace ricochet::test_support
