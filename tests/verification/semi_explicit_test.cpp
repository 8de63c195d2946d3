#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/scheme/critical_step.hpp"
#include "ricochet/scheme/semi_explicit/requirements.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"
#include "support/strip.hpp"
#include "support/thrown_body.hpp"

// The semi-explicit scheme: its critical step compared with dense eigenvalues, closed forms and runs on both sides of
// it, its refusals, and its motion compared with newmark with the equivalent mass.

namespace ricochet::test_support::semi_explicit_test {

constexpr const char* semi_explicit = "scheme = \"semi-explicit\"\n";

/// Largest eigenvalue of M⁻¹K on the dofs with mass and without support; `condensed`: contact dofs follow statically.
double dense_eigenvalue(const SemidiscreteProblem& problem, bool condensed) {
  std::vector<Index> inside;
  for (Index dof = 0; dof < problem.dof_count(); ++dof) {
    if (problem.is_massless[std::size_t(dof)] == 0 && !problem.supports.contains(dof)) {
      inside.push_back(dof);
    }
  }
  const Matrix stiffness = problem.internal_force->tangent();
  Matrix k = stiffness(inside, inside);
  if (condensed) {
    const Matrix beside = stiffness(problem.contact_dofs, inside);
    const Matrix contact = stiffness(problem.contact_dofs, problem.contact_dofs);
    k -= beside.transpose() * contact.ldlt().solve(beside);
  }
  const Vector scale = Vector(problem.mass.diagonal())(inside).cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * k * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// A simulation with this step, regardless of the critical one, from random velocities.
struct UncheckedRun {
  std::unique_ptr<Scheme> scheme;
  std::unique_ptr<Simulation> simulation;
  double first = 0.0, largest = 0.0;  ///< total energy, without any supply

  UncheckedRun(const CaseRun& run, double step, int steps) {
    scheme = make_semi_explicit_at_any_step(step);
    InitialConditions initial = run.model().initial;
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> random(-0.5, 0.5);
    for (double& v : initial.velocity) v += random(generator);
    simulation = std::make_unique<Simulation>(run.problem(), *scheme, initial);
    first = simulation->account().energies(simulation->state()).total();
    try {
      for (int k = 0; k < steps && largest < 1e6 * first; ++k) {
        simulation->advance();
        largest = std::max(largest, simulation->account().energies(simulation->state()).total());
      }
    } catch (const Error&) {
      largest = INFINITY;
    }
  }
};

TEST(SemiExplicit, CriticalStepAgainstDenseEigenvalues) {
  for (const ThrownBody& body : thrown_bodies()) {
    CaseRun run(thrown_case(body, "equivalent-lumped", semi_explicit), {"time.step=0.002"});
    const double stuck = dense_eigenvalue(run.problem(), false);
    const double open = dense_eigenvalue(run.problem(), true);
    const double found = bound_frequency_squared(run.problem());
    EXPECT_GE(found, stuck) << body.name;
    EXPECT_LE(found, 1.0205 * stuck) << body.name;
    EXPECT_LE(open, stuck * (1.0 + 1e-12)) << body.name << ": contact nodes that are held are the worst case";
    EXPECT_EQ(run.scheme().critical_step(), 2.0 / std::sqrt(found)) << body.name;
    std::printf("%-26s critical step %.5f (stuck), %.5f (open)\n", body.name.c_str(), 2.0 / std::sqrt(stuck),
                2.0 / std::sqrt(open));
  }
}

/// A bar of 20 quadrilaterals of size ½ without contact: c = 30, so that waves cross a cell in 1/60.
std::string bar() {
  const std::string toml = strip_case(strip_mesh(0.0, 10.0, 20, false), 900.0, 1.0, 1);
  return toml.substr(0, toml.find("[obstacle")) + "[mass]\ntype = \"lumped\"\n[time]\nend = 1.0\n" + semi_explicit;
}

TEST(SemiExplicit, CriticalStepOfAUniformBarIsTheTimeAWaveTakesThroughACell) {
  CaseRun run(bar(), {"time.step=0.01"});
  EXPECT_LE(run.scheme().critical_step(), 1.0 / 60.0);
  EXPECT_GE(run.scheme().critical_step(), 0.989 / 60.0);
}

TEST(SemiExplicit, RunsAreBoundedBelowTheCriticalStepAndBlowUpAbove) {
  const CaseRun run(bar(), {"time.step=0.01"});
  // J − (h²/8)AᵀMA is constant, and (h²/8)AᵀMA is at most r²J without loads, r the fraction of the critical step.
  const UncheckedRun below(run, 0.999 / 60.0, 5000);
  EXPECT_LT(below.largest, below.first / (1.0 - 0.999 * 0.999));
  const UncheckedRun above(run, 1.005 / 60.0, 5000);
  EXPECT_GT(above.largest, 1e6 * above.first);
}

TEST(SemiExplicit, BouncingBodiesAreBoundedBelowTheirCriticalStep) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const char* contact : {"", "friction = 0.5\n"}) {
      CaseRun run(thrown_case(body, "equivalent-lumped", semi_explicit, contact), {"time.step=0.001"});
      const UncheckedRun below(run, 0.98 * run.scheme().critical_step(), 1000);
      EXPECT_LT(below.largest, 3.0 * below.first) << body.name;
      // Above the limit for open contact, the higher one.
      const UncheckedRun above(run, 2.1 / std::sqrt(dense_eigenvalue(run.problem(), true)), 1000);
      EXPECT_GT(above.largest, 1e6 * above.first) << body.name;
    }
  }
}

TEST(SemiExplicit, RefusesAStepAboveTheCriticalOneAndWarnsNearIt) {
  CaseRun run(bar(), {"time.step=0.01"});
  const double critical = run.scheme().critical_step();
  expect_error({fmt::format("1.01 times the critical step, {:.6g}", critical), "set time.step = "},
               [&] { const CaseRun refused(bar(), {fmt::format("time.step={:.17g}", 1.01 * critical)}); });
  CaseRun near(bar(), {fmt::format("time.step={:.17g}", 0.95 * critical)});
  ASSERT_EQ(near.session().warnings().size(), 1u);
  const std::string warning = near.session().warnings().front();
  EXPECT_TRUE(has(warning, "0.95 of the critical step"));
  CaseRun well_below(bar(), {fmt::format("time.step={:.17g}", 0.85 * critical)});
  EXPECT_TRUE(well_below.session().warnings().empty());
}

void expect_refusal(const std::string& toml, const std::vector<std::string>& overrides, const std::string& part) {
  expect_error({part}, [&] { const CaseRun run(toml, overrides); });
}

TEST(SemiExplicit, RefusesOtherMassesAndStiffnessDamping) {
  const std::string toml = thrown_case(thrown_bodies().front(), "equivalent-lumped", semi_explicit);
  for (const char* mass : {"consistent", "equivalent"}) {
    expect_refusal(toml, {std::string("mass.type=") + mass}, "is not diagonal; set mass.type = \"equivalent-lumped\"");
  }
  expect_refusal(toml, {"mass.type=lumped"}, "without inertia on the contact nodes: ");
  expect_refusal(toml, {"material.0.damping.stiffness=0.001"},
                 "does not support damping proportional to the stiffness");
}

TEST(SemiExplicit, StartsWithoutAFactorOfTheMass) {
  CaseRun run(thrown_case(thrown_bodies().front(), "equivalent-lumped", semi_explicit), {"time.step=0.002"});
  const auto contact = std::size_t(run.problem().contact_dofs.size());
  EXPECT_LE(run.simulation().factor_entries(), contact * contact) << "the system of the contact dofs alone";
}

/// Largest difference of displacements between two runs, relative to the largest displacement, and the ratio of the
/// impulses of the obstacle.
struct Comparison {
  double difference = 0.0, impulse_ratio = 0.0;
};

Comparison compare(CaseRun& left, CaseRun& right) {
  double difference = 0.0, moved = 0.0, of_left = 0.0, of_right = 0.0;
  left.run([&] {
    if (left.state().step > 0) right.simulation().advance();
    const Vector& u = right.state().displacement;
    difference = std::max(difference, (left.state().displacement - u).lpNorm<Eigen::Infinity>());
    moved = std::max(moved, u.lpNorm<Eigen::Infinity>());
    of_left += left.state().forces.normal_reaction.sum();
    of_right += right.state().forces.normal_reaction.sum();
  });
  return {difference / moved, of_left / of_right};
}

constexpr const char* trapezoidal = "scheme = \"newmark\"\npreset = \"trapezoidal\"\n";

TEST(SemiExplicit, ConvergesToNewmarkWithTheSameMass) {
  // The impact excites all frequencies of the mesh, so the order is low, but halving the step brings the two together.
  for (const char* contact : {"", "friction = 0.4\n"}) {
    double before = INFINITY;
    for (const char* step : {"time.step=0.02", "time.step=0.01", "time.step=0.005", "time.step=0.0025"}) {
      const ThrownBody body = thrown_bodies().front();
      CaseRun left(thrown_case(body, "equivalent-lumped", semi_explicit, contact), {step});
      CaseRun right(thrown_case(body, "equivalent-lumped", trapezoidal, contact), {step});
      const Comparison found = compare(left, right);
      std::printf("%s: displacements differ by %.5f, impulses by %.5f\n", step, found.difference,
                  found.impulse_ratio - 1.0);
      EXPECT_LT(found.difference, 0.6 * before) << step;
      EXPECT_NEAR(found.impulse_ratio, 1.0, 0.02) << step;
      before = found.difference;
    }
    EXPECT_LT(before, 1e-3);
  }
}

TEST(SemiExplicit, MovesAsNewmarkWithTheEquivalentMass) {
  // The two masses differ by O(h²), as each does from the consistent one. (The balls and the blocks have too few free
  // nodes to compare.)
  for (const char* contact : {"", "friction = 0.4\n"}) {
    for (const ThrownBody& body : thrown_bodies()) {
      if (body.dimension == 3 || !body.against.empty()) continue;
      CaseRun left(thrown_case(body, "equivalent-lumped", semi_explicit, contact), {"time.step=0.005"});
      CaseRun right(thrown_case(body, "equivalent", trapezoidal, contact), {"time.step=0.005"});
      const Comparison found = compare(left, right);
      std::printf("%s: displacements differ by %.4f, impulses by %.4f\n", body.name.c_str(), found.difference,
                  found.impulse_ratio - 1.0);
      EXPECT_LT(found.difference, 0.1) << body.name;
      EXPECT_NEAR(found.impulse_ratio, 1.0, 0.03) << body.name;
    }
  }
}

TEST(SemiExplicit, AccountClosesThoughAStiffBodyMovesFar) {
  // Steel in SI units that flies 5 m at 100 m/s: forces on the massless nodes must not be the rounding of K times that.
  ThrownBody body = thrown_bodies().front();
  CaseRun run(thrown_case(body, "equivalent-lumped", semi_explicit),
              {"material.0.density=7850", "material.0.lambda=1.2e11", "material.0.mu=8e10", "time.step=1e-5",
               "time.end=0.05", "initial.velocity=[60.0,80.0]"});
  double worst = 0.0, largest = 0.0, strain = 0.0;
  run.run([&] {
    const Energies now = run.simulation().account().energies(run.state());
    largest = std::max(largest, now.kinetic);
    strain = std::max(strain, now.elastic);
    worst = std::max(worst, std::abs(run.simulation().account().residual(now)));
  });
  EXPECT_GT(run.state().displacement[1], 3.9);
  EXPECT_LT(worst, 1e-11 * largest);
  EXPECT_LT(strain, 1e-18 * largest);
}

}  // namespace ricochet::test_support::semi_explicit_test
