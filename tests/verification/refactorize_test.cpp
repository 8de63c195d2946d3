#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"
#include "ricochet/scheme/critical_step.hpp"
#include "ricochet/simulation/simulation.hpp"
#include "ricochet/step/contact_conditions.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Operators that depend on the displacement: stages are solved with the requested tangent, and solvers that rely
/// on a constant one refuse.
namespace ricochet::test_support::refactorize_test {

/// A force of the form (1 + |U|_∞) K U: solvers use its tangent only.
class Stiffening final : public InternalForce {
 public:
  explicit Stiffening(const InternalForce& linear) : linear_(linear) {}
  void evaluate(const Vector& displacement, Vector& force) const override {
    linear_.evaluate(displacement, force);
    force *= factor(displacement);
  }
  using InternalForce::energy;
  [[nodiscard]] double energy(const Vector& displacement) const override {
    return factor(displacement) * linear_.energy(displacement);
  }
  [[nodiscard]] bool is_linear() const override { return false; }
  [[nodiscard]] SparseMatrix tangent(const Vector& displacement) const override {
    return factor(displacement) * linear_.tangent();
  }

 private:
  static double factor(const Vector& displacement) {
    return displacement.size() > 0 ? 1.0 + displacement.lpNorm<Eigen::Infinity>() : 1.0;
  }
  const InternalForce& linear_;
};

std::string block_case(const std::string& more = "") {
  return thrown_case(one_sided_block(), "consistent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n",
                     "friction = 0.3\n") +
         more;
}

/// A stage that presses and drags the block.
Stage pressed_stage(const SemidiscreteProblem& problem) {
  Stage stage;
  stage.right_hand_side.force.setZero(problem.dof_count());
  for (Index i = 0; i < problem.dof_count(); ++i) stage.right_hand_side.force[i] = i % 2 == 0 ? 0.02 : -0.3;
  stage.right_hand_side.prescribed.setZero(problem.supports.size());
  const Vector base = Vector::Zero(problem.dof_count());
  require_no_penetration(problem, base, 0.0, stage);
  require_friction(problem, base, 1.0, stage);
  return stage;
}

class Refactorize : public ::testing::TestWithParam<SolverMethod> {};

TEST_P(Refactorize, SolvesWithTheTangentAtTheDisplacement) {
  const CaseRun run(block_case());
  SemidiscreteProblem problem = run.problem();
  problem.internal_force = std::make_shared<Stiffening>(*run.problem().internal_force);
  const StepSolverOptions options{.method = GetParam()};
  const std::vector<OperatorCoefficients> operators{{50.0, 1.0, 0.0}};
  const auto solver = make_step_solver(problem, operators, options);
  Stage stage = pressed_stage(problem);
  StageSolution undeformed, found, wanted;
  solver->solve(0, stage, undeformed);
  ASSERT_GT(undeformed.normal_reaction.maxCoeff(), 0.0);
  for (const double size : {0.25, 3.0}) {
    Vector displacement = Vector::Zero(problem.dof_count());
    displacement[1] = size;
    solver->refactorize(0, displacement);
    solver->solve(0, stage, found);
    // The same operator in a new solver.
    const auto other = make_step_solver(run.problem(), {{50.0, 1.0 + size, 0.0}}, options);
    other->solve(0, stage, wanted);
    const double scale = wanted.increment.lpNorm<Eigen::Infinity>();
    EXPECT_LE((found.increment - wanted.increment).lpNorm<Eigen::Infinity>(), 1e-9 * scale);
    EXPECT_LE((found.normal_reaction - wanted.normal_reaction).lpNorm<Eigen::Infinity>(),
              1e-9 * wanted.normal_reaction.maxCoeff());
    EXPECT_GT((found.increment - undeformed.increment).lpNorm<Eigen::Infinity>(), 1e-3 * scale);
  }
  solver->refactorize(0, Vector());
  solver->solve(0, stage, found);
  if (GetParam() == SolverMethod::direct) {
    EXPECT_EQ(found.increment, undeformed.increment);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Refactorize, ::testing::Values(SolverMethod::direct, SolverMethod::iterative));

TEST(NonlinearForce, IsRefusedWhereATangentIsTakenForConstant) {
  const CaseRun run(block_case());
  SemidiscreteProblem problem = run.problem();
  problem.internal_force = std::make_shared<Stiffening>(*run.problem().internal_force);
  for (const std::string& name : scheme_names()) {
    const auto scheme =
        name == "newmark" ? make_scheme(name, 0.01, {{"preset", "trapezoidal"}}) : make_scheme(name, 0.01);
    if (scheme->traits().supports_nonlinear_force) continue;
    EXPECT_THROW(Simulation(problem, *scheme, run.model().initial), Error) << name;
  }
}

}  // namespace ricochet::test_support::refactorize_test
