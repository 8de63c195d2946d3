#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"

/// @file The critical step of semi-explicit at finite strain changes with the deformation: it is followed, and longer
/// steps are not taken.
namespace ricochet::test_support::finite_critical_step_test {

/// 2/√λ with the largest eigenvalue λ of M⁻¹K on the dofs with mass, for the tangent at this displacement.
double dense_critical_step(const SemidiscreteProblem& problem, const Vector& displacement) {
  std::vector<Index> inside;
  for (Index dof = 0; dof < problem.dof_count(); ++dof) {
    if (problem.is_massless[std::size_t(dof)] == 0 && !problem.supports.contains(dof)) inside.push_back(dof);
  }
  const Matrix stiffness = problem.internal_force->tangent(displacement);
  const Vector scale = Vector(problem.mass.diagonal())(inside).cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * stiffness(inside, inside) * scale.asDiagonal();
  return 2.0 /
         std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

double energy_of(const CaseRun& run) {
  return 0.5 * run.problem().mass.quadratic_form(run.state().velocity) +
         run.problem().internal_force->energy(run.state().displacement);
}

/// A block squeezed from above by a press: an obstacle that moves with `speed` along y, on a block held below.
std::string press(double speed, double step, double end, const std::string& more = "") {
  const std::string mesh = mesh_geometry("finite-pressed-2d",
                                         "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                         "Physical Curve(\"bottom\") = {1};\nPhysical Curve(\"top\") = {3};\n",
                                         0.125, 1);
  return "[mesh]\nfile = \"" + mesh +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\nlaw = \"neo-hookean\"\n"
         "[obstacle.press]\ntype = \"plane\"\npoint = [0, 0.5001]\nnormal = [0, -1]\nvelocity = [0, " +
         fmt::format("{:.17g}", -speed) +
         "]\n[[contact]]\ngroup = \"top\"\nobstacle = \"press\"\n[[support]]\ngroup = \"bottom\"\ncomponents = "
         "[\"x\", \"y\"]\n" +
         more + "[mass]\ntype = \"equivalent-lumped\"\n[time]\nscheme = \"semi-explicit\"\n" +
         fmt::format("step = {:.17g}\nend = {:.17g}\n", step, end);
}

double critical_of_rest(const std::string& text) {
  CaseRun run(text);
  return run.scheme().critical_step();
}

TEST(FiniteCriticalStep, FollowsTheCriticalStepOfASqueezedBlock) {
  const double rest = critical_of_rest(press(1.0, 1e-4, 1e-3));
  CaseRun run(press(1.0, 0.4 * rest, 0.3));
  double least = INFINITY, smallest = 0.0, worst = 0.0;
  while (run.session().step()) {
    const double exact = dense_critical_step(run.problem(), run.state().displacement);
    least = std::min(least, exact);
    smallest = run.scheme().critical_step();
    worst = std::max(worst, smallest / least - 1.0);
  }
  std::printf("critical step at rest %.5g, the least %.5g; found %.5g, at most %.3g too large\n", rest, least, smallest,
              worst);
  EXPECT_LT(least, 0.75 * rest);
  EXPECT_NEAR(smallest / least, 1.0, 0.1);
}

/// Near the limit every check matters: the estimate is within some per cent of the exact value, in time.
TEST(FiniteCriticalStep, AStepThatBecomesTooLongEndsTheRunBeforeItBlowsUp) {
  const double rest = critical_of_rest(press(1.0, 1e-4, 1e-3));
  for (const double part : {0.7, 0.85, 0.95}) {
    CaseRun run(press(1.0, part * rest, 0.4));
    double exact = 0.0;
    double most = 0.0;
    const std::vector<std::string> parts{"the critical step of \"semi-explicit\" is", "set time.step = "};
    const std::string message = expect_error(ErrorKind::not_converged, parts, [&] {
      while (run.session().step()) {
        exact = dense_critical_step(run.problem(), run.state().displacement);
        const Energies energies = run.simulation().account().energies(run.state());
        most = std::max(most, std::abs(energies.algorithmic) / (energies.kinetic + energies.elastic));
      }
    });
    std::printf("step %.2f of the critical one at rest: ended at %.3f of the exact one. %s\n", part,
                part * rest / exact, message.c_str());
    EXPECT_FALSE(has(message, "finer mesh"));
    EXPECT_NEAR(part * rest / exact, 1.0, 0.06);
    EXPECT_LT(most, 0.5) << "nothing has blown up";
    bool warned = false;
    for (const std::string& warning : run.session().warnings())
      warned = warned || warning.find("are deformed so much that the critical step is") != std::string::npos;
    EXPECT_EQ(warned, part < 0.9);
  }
}

/// Blocks that strike the floor with a corner, at up to half the wave speed: no step is longer than the critical one of
/// its start, except for a few undetected per cent.
TEST(FiniteCriticalStep, NoStepOfAHardImpactIsBeyondTheCriticalOne) {
  const std::string mesh =
      mesh_geometry("finite-corner-2d",
                    "Rectangle(1) = {0, 0, 0, 1, 0.5};\nRotate {{0,0,1},{0,0,0},0.5} {Surface{1};}\n"
                    "Physical Surface(\"body\") = {1};\nPhysical Curve(\"skin\") = {1,2,3,4};\n",
                    0.11, 1);
  int ended = 0;
  for (const std::string law : {"neo-hookean", "saint-venant-kirchhoff"}) {
    for (const double speed : {1.5, 5.0}) {
      const std::string text =
          "[mesh]\nfile = \"" + mesh +
          "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\nlaw = \"" + law +
          "\"\n[obstacle.floor]\ntype = \"plane\"\npoint = [0, -0.01]\nnormal = [0, 1]\n[[contact]]\ngroup = "
          "\"skin\"\nobstacle = \"floor\"\nfriction = 0.3\n[initial]\nvelocity = " +
          fmt::format("[\"0\", \"{}\"]", -speed) +
          "\n[mass]\ntype = \"equivalent-lumped\"\n[time]\nscheme = \"semi-explicit\"\nstep = 1e-4\nend = 0.3\n";
      const double rest = critical_of_rest(text);
      for (const double part : {0.6, 0.8, 0.95}) {
        CaseRun run(text, {fmt::format("time.step={:.17g}", part * rest)});
        const double start = energy_of(run);
        const std::string what = fmt::format("{} {} {}", law, speed, part);
        try {
          while (true) {
            const double exact = dense_critical_step(run.problem(), run.state().displacement);
            if (!run.session().step()) break;
            EXPECT_LT(part * rest, 1.04 * exact) << what;
            EXPECT_LT(energy_of(run), 1.02 * start) << what;
          }
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::not_converged);
          EXPECT_TRUE(has(error.what(), "critical step"));
          ++ended;
        }
      }
    }
  }
  EXPECT_GT(ended, 0);
  EXPECT_LT(ended, 12);
}

/// Cells that a step inverts are named, with the critical step and advice.
TEST(FiniteCriticalStep, InvertedCellsAreNamed) {
  const double rest = critical_of_rest(press(1.0, 1e-4, 1e-3));
  CaseRun run(press(25.0, 0.3 * rest, 0.1));
  expect_error(ErrorKind::not_converged, {"step ", "cell ", "critical step", "time.step"}, [&] {
    while (run.session().step()) continue;
  });
}

TEST(FiniteCriticalStep, RefusesAStartBeyondTheCriticalStep) {
  const std::string squeezed = "[initial]\ndisplacement = [\"0\", \"-0.45*y\"]\n";
  const double rest = critical_of_rest(press(1.0, 1e-4, 1e-3));
  std::string text = press(0.0, 0.95 * rest, 0.1, squeezed);
  text.replace(text.find("components = [\"x\", \"y\"]"), 23, "components = [\"y\"]     ");
  expect_error({"times the critical step"}, [&] { CaseRun run(text); });
}

}  // namespace ricochet::test_support::finite_critical_step_test
