#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/case_run.hpp"
#include "support/errors.hpp"

/// @file Schemes with the internal force at the middle of a step, at finite strain: its difference from the change of
/// the elastic energy is in the account.
namespace ricochet::test_support::finite_midpoint_test {

/// A block of E = 100, ρ = 1 that is stretched and spins, `height` above a floor.
std::string block(const std::string& scheme, double step, double end, double height, const std::string& friction = {}) {
  const std::string mesh = mesh_geometry("finite-midpoint",
                                         "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                         "Physical Curve(\"bottom\") = {1};\n",
                                         0.125, 1);
  return "[mesh]\nfile = \"" + mesh +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\nlaw = \"neo-hookean\"\n"
         "[obstacle.floor]\ntype = \"plane\"\npoint = [0, " +
         std::to_string(-height) + "]\nnormal = [0, 1]\n[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" +
         friction +
         "[initial]\ndisplacement = [\"0.02*sin(5*x)\", \"0.02*sin(5*y)\"]\n"
         "velocity = [\"0.3-2*(y-0.25)\", \"-0.5+2*(x-0.5)\"]\n[mass]\ntype = \"consistent\"\n[time]\nscheme = \"" +
         scheme + "\"\n" + fmt::format("step = {}\nend = {}\n", step, end);
}

/// Largest residual of the account relative to the largest energy, and largest error of a step.
struct Measured {
  double residual = 0.0, first_error = 0.0, largest_error = 0.0, largest_force = 0.0;
};

Measured measure(const std::string& text) {
  CaseRun run(text);
  Measured result;
  double energy = 0.0, before = 0.0, residual = 0.0;
  run.run(
      [&] {
        EnergyAccount& account = run.simulation().account();
        const Energies now = account.energies(run.state());
        energy = std::max(energy, now.total());
        residual = std::max(residual, std::abs(account.residual(now)));
        const double error = account.works().integration_error - before;
        before = account.works().integration_error;
        if (run.state().step == 1) result.first_error = error;
        result.largest_error = std::max(result.largest_error, std::abs(error));
        result.largest_force = std::max(result.largest_force, run.state().forces.normal_reaction.sum());
      },
      false);
  result.residual = residual / energy;
  return result;
}

/// The sum of the account is zero by the equations of the step, for steps of any length.
TEST(FiniteMidpoint, TheAccountClosesInFlightAndInContact) {
  for (const std::string scheme : {"midpoint", "kane"}) {
    const Measured flight = measure(block(scheme, 0.01, 2.0, 10.0));
    EXPECT_LT(flight.residual, 1e-12) << scheme;
    EXPECT_GT(flight.largest_error, 1e-7) << scheme << ": an error that the test must detect exists";
    EXPECT_EQ(flight.largest_force, 0.0);
    const Measured bounce = measure(block(scheme, 0.01, 1.0, 0.05, "friction = 0.3\n"));
    EXPECT_LT(bounce.residual, 1e-12) << scheme;
    EXPECT_GT(bounce.largest_force, 0.1) << scheme;
  }
}

/// ΔW − ΔU·f(U₀+½ΔU) is (1/24) W‴ΔU³ and higher odd terms: from the same state half the step has an eighth of it. (The
/// block stretches: for a rotation alone W‴ is nearly zero.)
TEST(FiniteMidpoint, TheErrorOfAStepIsOfThirdOrder) {
  for (const std::string scheme : {"midpoint", "kane"}) {
    std::vector<double> errors;
    for (const double step : {4e-4, 2e-4, 1e-4}) {
      std::string text = block(scheme, step, 2.0 * step, 10.0);
      const std::string along = "0.3-2*(y-0.25)";
      text.replace(text.find(along), along.size(), along + "+x");
      errors.push_back(std::abs(measure(text).first_error));
    }
    EXPECT_GT(errors.back(), 1e-13) << scheme << ": more than rounding";
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 3.0, 0.15) << scheme;
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), 3.0, 0.08) << scheme;
  }
}

/// A case is refused earlier, at the line of its law; this message is for programs that combine a problem and a scheme.
TEST(FiniteMidpoint, SchemesOfTheLinearLawAreRefused) {
  std::string text = block("midpoint", 1e-3, 1e-2, 10.0);
  const CaseRun run(text);
  const std::unique_ptr<Scheme> scheme = make_scheme("klr-conserving", 1e-3);
  expect_error({"needs a linear material law: set material.law = \"linear\""},
               [&] { const Simulation simulation(run.problem(), *scheme, run.model().initial); });
  const std::string law = "neo-hookean";
  const CaseRun linear(text.replace(text.find(law), law.size(), "linear"));
  EXPECT_NO_THROW(Simulation(linear.problem(), *scheme, linear.model().initial));
}

}  // namespace ricochet::test_support::finite_midpoint_test
