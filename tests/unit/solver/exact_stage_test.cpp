#include "ricochet/solver/exact/exact_stage.hpp"

#include <gtest/gtest.h>

#include <random>

#include "ricochet/base/error.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Contact problems of exact tangents, on a few unknowns that are no body's.
namespace ricochet::test_support {
namespace {

/// Random equations for the contact points of a block: J is a diagonal plus unsymmetric noise, forces and motions of a
/// point differ.
struct RandomStep {
  CaseRun run;
  ExactTangent tangent;
  std::vector<char> eligible;

  RandomStep(const std::string& friction, unsigned seed, double noise)
      : run(thrown_case(one_sided_block(), "consistent", time_of("newmark"), friction)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    const Index points = run.problem().contact.size(), tangents = run.problem().dimension - 1;
    const Index unknowns = 2 * points * (tangents + 1);
    const auto sparse = [&](Index rows, const auto& entry) {
      std::vector<Eigen::Triplet<double>> entries;
      for (Index i = 0; i < rows; ++i)
        for (Index j = 0; j < unknowns; ++j)
          if (const double value = entry(i, j); value != 0.0) entries.emplace_back(int(i), int(j), value);
      SparseRowMatrix result(rows, unknowns);
      result.setFromTriplets(entries.begin(), entries.end());
      return result;
    };
    tangent.matrix =
        SparseMatrix(sparse(unknowns, [&](Index i, Index j) { return (i == j ? 2.0 : 0.0) + noise * number(random); }));
    tangent.right_hand_side = Vector::NullaryExpr(unknowns, [&] { return number(random); });
    const auto of_row = [&](Index first) {
      return [&, first](Index i, Index j) { return (j == first + i ? 1.0 : 0.0) + noise * number(random); };
    };
    tangent.normal_force = sparse(points, of_row(0));
    tangent.normal_motion = sparse(points, of_row(0));
    tangent.tangential_force = sparse(points * tangents, of_row(points));
    tangent.tangential_motion = sparse(points * tangents, of_row(points));
    tangent.gap = Vector::NullaryExpr(points, [&] { return 0.3 * number(random); });
    tangent.slip = Vector::NullaryExpr(points * tangents, [&] { return 0.3 * number(random); });
    tangent.gap_rounding = tangent.slip_rounding = Vector::Constant(points, 1e-15);
    eligible.assign(std::size_t(points), 1);
  }

  void expect_solved(double friction) {
    ExactStage stage(run.problem());
    StageSolution solution;
    Vector z;
    stage.solve(tangent, eligible, solution, z);
    const Vector &r = solution.normal_reaction, &t = solution.tangential_reaction;
    Vector force = tangent.right_hand_side + tangent.normal_force.transpose() * r;
    if (t.size() > 0) force -= tangent.tangential_force.transpose() * t;
    EXPECT_LT((tangent.matrix * z - force).norm(), 1e-12 * force.norm());
    const Vector y = tangent.gap + tangent.normal_motion * z, w = tangent.slip + tangent.tangential_motion * z;
    Index pressed = 0;
    for (Index i = 0; i < r.size(); ++i) {
      EXPECT_GE(r[i], 0.0);
      EXPECT_GE(y[i], -1e-12);
      EXPECT_LT(r[i] * y[i], 1e-11);
      pressed += r[i] > 0.0 ? 1 : 0;
      if (t.size() == 0) continue;
      EXPECT_LE(std::abs(t[i]), friction * r[i] + 1e-12);
      if (!(std::abs(w[i]) > 1e-10 && r[i] > 0.0)) continue;
      EXPECT_NEAR(t[i], friction * r[i] * (w[i] > 0.0 ? 1.0 : -1.0), 1e-11);
    }
    EXPECT_GT(pressed, 0);
  }
};

TEST(ExactStage, MeetsTheConditionsWithUnsymmetricOperators) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomStep("", seed, 0.02).expect_solved(0.0);
    RandomStep("friction = 0.3\n", seed, 0.02).expect_solved(0.3);
  }
}

/// With J negative at a pressed point its gap closes under a force that pulls: W is negative, and the problem refused.
/// The contact stiffness of the last iteration makes it definite, and the point stays closed.
TEST(ExactStage, AddsContactStiffnessToIndefiniteTangents) {
  RandomStep step("", 5, 0.0);
  step.tangent.matrix.coeffRef(0, 0) = -1.0;
  step.tangent.gap[0] = 0.0;
  step.tangent.right_hand_side[0] = -2.0;
  ExactStage stage(step.run.problem());
  StageSolution solution;
  Vector z;
  solution.normal_reaction.setZero(step.run.problem().contact.size());
  solution.normal_reaction[0] = 1.0;
  stage.solve(step.tangent, step.eligible, solution, z);
  EXPECT_NEAR(z[0], 0.0, 1e-12);
  EXPECT_NEAR(solution.normal_reaction[0], 2.0, 1e-12);
}

}  // namespace
}  // namespace ricochet::test_support
