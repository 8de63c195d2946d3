#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/simulation/history/history.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "support/block_flight.hpp"
#include "support/case_run.hpp"
#include "support/motion_totals.hpp"
#include "support/thrown_body.hpp"

/// @file Finite rotations and strains: the balances of every step.
namespace ricochet::test_support::finite_strain_test {

struct Flight {
  int dimension = 2;
  std::string scheme = "reduced-kane", law = "neo-hookean", mass = "equivalent";
  double step = 0.01, height = 10.0;
  std::string more = {};
  int steps = 200;
};

/// A block of E = 100, ρ = 1 above a floor, stretched and spinning.
std::string case_of(const Flight& flight, const std::string& displacement, const std::string& velocity) {
  const bool plane = flight.dimension == 2;
  return "[mesh]\nfile = \"" + finite_block(flight.dimension, 0.2) +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\nlaw = \"" + flight.law +
         "\"\n[obstacle.floor]\ntype = \"plane\"\npoint = " + (plane ? "[0, -" : "[0, -") +
         std::to_string(flight.height) + (plane ? "]\nnormal = [0, 1]\n" : ", 0]\nnormal = [0, 1, 0]\n") +
         "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" + flight.more +
         "[initial]\ndisplacement = " + displacement + "\nvelocity = " + velocity + "\n[mass]\ntype = \"" +
         flight.mass + "\"\n[time]\nscheme = \"" + flight.scheme + "\"\n" +
         (flight.scheme == "newmark" ? "preset = \"trapezoidal\"\n" : "") + "step = " + std::to_string(flight.step) +
         "\nend = " + std::to_string(flight.steps * flight.step) + "\n";
}

const std::vector<std::string>& exact_schemes() {
  static const std::vector<std::string> all{"reduced-kane", "mean-reaction", "reduced-midpoint"};
  return all;
}

TEST(FiniteStrain, FreeFlightKeepsEnergyAndMomenta) {
  for (const int dimension : {2, 3}) {
    for (const std::string& scheme : exact_schemes()) {
      for (const std::string law : {"neo-hookean", "saint-venant-kirchhoff"}) {
        CaseRun run(
            case_of({.dimension = dimension, .scheme = scheme, .law = law}, stretched(dimension), spinning(dimension)));
        const double energy = energy_of(run);
        const Momenta start(run);
        run.run([&] {
          EXPECT_NEAR(energy_of(run), energy, 1e-12 * energy) << scheme << " " << law;
          const Momenta now(run);
          EXPECT_LT((now.linear - start.linear).norm(), 1e-13);
          EXPECT_LT((now.angular - start.angular).norm(), 1e-12) << scheme;
        });
      }
    }
  }
}

/// Strains of 10⁻⁷: energies are differences of small numbers. (Displacements of 10⁻⁵ have a rounding of 10⁻¹⁴ of
/// those.)
TEST(FiniteStrain, SmallVibrationsKeepEnergyAsExactly) {
  for (const std::string& scheme : exact_schemes()) {
    for (const double step : {0.01, 0.2}) {
      CaseRun run(case_of({.scheme = scheme, .step = step}, "[\"2e-8*sin(5*x)\", \"0\"]", "[\"1e-6*y\", \"0\"]"));
      const double energy = energy_of(run);
      run.run([&] { EXPECT_NEAR(energy_of(run), energy, 1e-11 * energy) << scheme << step << run.state().step; });
    }
  }
}

/// Bouncing: energy is exact without friction under the mean of the reactions, and never increases under reactions at
/// the end; the account closes, and both momenta change by the impulses.
TEST(FiniteStrain, BouncingBalances) {
  for (const int dimension : {2, 3}) {
    for (const std::string& scheme : exact_schemes()) {
      for (const std::string friction : {"", "friction = 0.4\n"}) {
        if (!friction.empty() && scheme != "reduced-kane") continue;
        Flight flight{.dimension = dimension, .scheme = scheme, .height = 0.05, .more = friction};
        CaseRun run(case_of(flight, stretched(dimension), falling(dimension)));
        const double start = energy_of(run);
        double before = start, largest_force = 0.0;
        const Momenta first(run);
        MomentumAccount momentum(run.problem(), run.scheme(), run.state());
        run.run(
            [&] {
              const double energy = energy_of(run);
              momentum.enter_step(run.state());
              const std::string what = scheme + friction + " step " + std::to_string(run.state().step);
              if (scheme == "reduced-kane") {
                EXPECT_LT(energy, before + 1e-12 * start) << what;
              } else {
                EXPECT_NEAR(energy, start, 1e-11 * start) << what;
              }
              before = energy;
              const Energies energies = run.simulation().account().energies(run.state());
              EXPECT_NEAR(run.simulation().account().residual(energies), 0.0, 1e-12 * start) << what;
              const Momenta now(run);
              EXPECT_LT((now.linear - first.linear - momentum.impulse().force).norm(), 1e-12) << what;
              EXPECT_LT((now.angular - first.angular - momentum.impulse().moment).norm(), 1e-11) << what;
              largest_force = std::max(largest_force, run.state().forces.normal_reaction.sum());
              Vector gap;
              run.problem().gaps(run.state().displacement, run.state().time, gap);
              EXPECT_GT(gap.minCoeff(), -1e-12) << what;
            },
            false);
        EXPECT_GT(largest_force, 0.1) << scheme;
      }
    }
  }
}

/// Axisymmetric bodies: energy is exact, and only motion along the axis has momentum.
TEST(FiniteStrain, AxisymmetricBodiesBounceWithExactEnergy) {
  std::string text = case_of({.scheme = "mean-reaction", .height = 0.05}, "[\"0.03*x*sin(3*y)\", \"0.02*sin(5*y)\"]",
                             "[\"0\", \"-0.5\"]");
  text.insert(text.find("[[material]]"), "plane = \"axisymmetric\"\n");
  CaseRun run(text);
  const double start = energy_of(run);
  MomentumAccount momentum(run.problem(), run.scheme(), run.state());
  Vector first, now;
  run.problem().mass.multiply(run.state().velocity, first);
  const auto along = [](const Vector& values) { return Vector(values.reshaped(2, values.size() / 2).row(1)).sum(); };
  double largest_force = 0.0;
  run.run(
      [&] {
        EXPECT_NEAR(energy_of(run), start, 1e-11 * start);
        momentum.enter_step(run.state());
        run.problem().mass.multiply(run.state().velocity, now);
        EXPECT_NEAR(along(now) - along(first), momentum.impulse().force[1], 1e-11);
        largest_force = std::max(largest_force, run.state().forces.normal_reaction.sum());
      },
      false);
  EXPECT_GT(largest_force, 1.0);
}

/// A rigid spin has no strain, however large the rotation in a step: bodies do not swell. (Their stretch is ρω²L²/E.)
TEST(FiniteStrain, ARigidSpinDoesNotSwell) {
  for (const int dimension : {2, 3}) {
    // In 3D such steps are subdivided: the mean configuration is narrower across its axis, and the operator is not.
    Flight flight{.dimension = dimension, .step = 500.0, .height = 1e6, .more = {}, .steps = 70};
    CaseRun run(case_of(
        flight, dimension == 2 ? "[\"0\", \"0\"]" : "[\"0\", \"0\", \"0\"]",
        dimension == 2 ? "[\"-1e-4*(y-0.25)\", \"1e-4*(x-0.5)\"]" : "[\"-1e-4*(y-0.25)\", \"1e-4*(x-0.5)\", \"0\"]"));
    const SemidiscreteProblem& problem = run.problem();
    const Points at_rest = problem.nodes.colwise() - problem.nodes.rowwise().mean();
    double turned = 0.0;
    run.run([&] {
      Points now = problem.nodes + run.state().displacement.reshaped(problem.dimension, problem.nodes.cols());
      now.colwise() -= Vector(now.rowwise().mean());
      for (Index node = 0; node < now.cols(); ++node) EXPECT_NEAR(now.col(node).norm(), at_rest.col(node).norm(), 1e-9);
      turned = std::max(turned, (now - at_rest).cwiseAbs().maxCoeff());
    });
    EXPECT_GT(turned, 1.0);  // it was upside down
  }
}

/// Superposed rotations of the whole motion change only the positions.
TEST(FiniteStrain, AMotionThatIsTurnedIsTheSameMotion) {
  for (const std::string scheme : {"reduced-kane", "mean-reaction", "newmark", "generalized-alpha"}) {
    const auto of_motion = [&](const std::string& displacement, const std::string& velocity) {
      return case_of({.scheme = scheme, .more = "[solver]\nnewton_tolerance = 1e-13\n"}, displacement, velocity);
    };
    expect_turned_motion(of_motion, "(-2*(y-0.25))", "(2*(x-0.5)+0.3*x*y)", scheme);
  }
}

/// In the limit of small loads the linear law gives the same results.
TEST(FiniteStrain, SmallMotionsAreLinear) {
  for (const std::string scheme : {"reduced-kane", "mean-reaction", "newmark", "generalized-alpha"}) {
    for (const std::string law : {"neo-hookean", "saint-venant-kirchhoff"}) {
      const auto run_law = [&](const std::string& name) {
        Flight flight{.scheme = scheme, .law = name, .height = 1e-9};
        return CaseRun(case_of(flight, "[\"1e-9*sin(5*x)\", \"1e-9*sin(5*y)\"]", "[\"0\", \"-1e-8\"]"));
      };
      expect_same_motion(run_law("linear"), run_law(law), scheme + " " + law);
    }
  }
}

/// Halving the step divides the error of a flight by four.
TEST(FiniteStrain, IsOfSecondOrder) {
  for (const std::string scheme : {"reduced-kane", "mean-reaction", "newmark", "kane", "midpoint"}) {
    const bool has_inertia = scheme == "kane" || scheme == "midpoint";
    const auto of_step = [&](double step, const std::string& displacement, const std::string& velocity) {
      const std::string mass = has_inertia ? "consistent" : "equivalent";
      return case_of({.scheme = scheme, .mass = mass, .step = step}, displacement, velocity);
    };
    expect_second_order(of_step, scheme);
  }
}

}  // namespace ricochet::test_support::finite_strain_test
