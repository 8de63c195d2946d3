#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "ricochet/simulation/history/history.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file A row of the history compared with its formulas and whole matrices: values reused from the step, and terms
/// left out because the mass allows it, change only the rounding.
namespace ricochet {
namespace {

using test_support::CaseRun;

/// Expected values of a row, and the sizes of the sums that determine its rounding.
struct Wanted {
  double kinetic = 0.0, elastic = 0.0;
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), angular_momentum = Eigen::Vector3d::Zero();
  double size = 0.0, arm = 0.0;
};

Wanted wanted_of(const SemidiscreteProblem& problem, const Vector& displacement, const Vector& velocity) {
  Wanted result;
  const SparseMatrix mass = problem.mass.to_sparse();
  const Vector momentum = mass * velocity;
  result.kinetic = 0.5 * velocity.dot(momentum);
  result.elastic = problem.internal_force->energy(displacement);
  const int d = problem.dimension;
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), p = Eigen::Vector3d::Zero();
    x.head(d) = problem.nodes.col(node);
    p.head(d) = momentum.segment(node * d, d);
    result.momentum += p;
    result.angular_momentum += x.cross(p);
    result.size += p.norm();
    result.arm = std::max(result.arm, x.norm());
  }
  return result;
}

void expect_row(const SemidiscreteProblem& problem, const std::vector<std::string>& columns,
                const std::vector<double>& row, const Wanted& wanted) {
  const auto at = [&](const std::string& name) { return row[column_index(columns, name)]; };
  EXPECT_NEAR(at("kinetic_energy"), wanted.kinetic, 1e-13 * wanted.kinetic);
  EXPECT_NEAR(at("elastic_energy"), wanted.elastic, 1e-12 * wanted.elastic);
  const std::string axes = "xyz";
  for (int k = 0; k < 3; ++k) {
    const std::string axis(1, axes[std::size_t(k)]);
    if (k < problem.dimension) {
      EXPECT_NEAR(at("momentum_" + axis), wanted.momentum[k], 1e-13 * wanted.size);
    }
    if (problem.dimension == 3 || k == 2) {
      EXPECT_NEAR(at("angular_momentum_" + axis), wanted.angular_momentum[k], 1e-13 * wanted.size * wanted.arm);
    }
  }
}

TEST(HistoryRow, HasEnergiesAndMomentaByTheirFormulas) {
  for (const test_support::ThrownBody& body : test_support::thrown_bodies()) {
    if (body.degree != 1) continue;
    for (const char* const scheme : {"semi-explicit", "newmark", "klr-conserving"}) {
      CaseRun run(test_support::thrown_case(body, test_support::masses_of(scheme).back(), test_support::time_of(scheme),
                                            "friction = 0.3\n"));
      const SemidiscreteProblem& problem = run.problem();
      HistoryRecorder recorder(problem, *run.model().rotation);
      double most_elastic = 0.0;
      for (int k = 0; k < 60; ++k) {
        const std::vector<double>& row = recorder.row(run.state(), run.simulation().account());
        Vector displacement, velocity;
        run.scheme().energy_state(run.state(), displacement, velocity);
        const Wanted wanted = wanted_of(problem, displacement, velocity);
        SCOPED_TRACE(body.name + ' ' + scheme + ' ' + std::to_string(k));
        expect_row(problem, recorder.columns(), row, wanted);
        most_elastic = std::max(most_elastic, wanted.elastic / (wanted.elastic + wanted.kinetic));
        run.simulation().advance();
      }
      EXPECT_GT(most_elastic, 1e-4) << "nothing was deformed";
    }
  }
}

/// Masses from densities act equally on all components; a mass that does not still has momenta.
TEST(HistoryRow, TakesAMassThatCouplesComponents) {
  CaseRun run(test_support::thrown_case(test_support::one_sided_block(), "consistent", "scheme = \"midpoint\"\n"));
  SemidiscreteProblem problem = run.problem();
  SparseMatrix mass = problem.mass.to_sparse();
  mass.coeffRef(0, 1) = mass.coeffRef(1, 0) = 0.3 * mass.coeff(0, 0);
  mass.makeCompressed();
  problem.mass = NodeMatrix(mass, problem.dimension);
  ASSERT_FALSE(problem.mass.is_scalar());
  State state = run.state();
  state.velocity = Vector::LinSpaced(problem.dof_count(), -1.0, 2.0);
  EnergyAccount account(problem, run.scheme(), state);
  HistoryRecorder recorder(problem, *run.model().rotation);
  expect_row(problem, recorder.columns(), recorder.row(state, account),
             wanted_of(problem, state.displacement, state.velocity));
}

}  // namespace
}  // namespace ricochet
