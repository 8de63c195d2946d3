#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/simulation/history/history.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "support/case_run.hpp"
#include "support/motion_totals.hpp"
#include "support/thrown_body.hpp"

/// @file Finite rotations and strains: the balances of every step.
namespace ricochet {
namespace finite_strain_test {

using test_support::CaseRun;
using test_support::energy_of;
using test_support::mesh_geometry;
using test_support::Momenta;

std::string block(int dimension) {
  return dimension == 2 ? mesh_geometry("finite-block-2d",
                                        "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                        "Physical Curve(\"bottom\") = {1};\n",
                                        0.125, 1)
                        : mesh_geometry("finite-block-3d",
                                        "Box(1) = {0, 0, 0, 1, 0.5, 0.6};\nPhysical Volume(\"body\") = {1};\n"
                                        "Physical Surface(\"bottom\") = {3};\n",
                                        0.2, 1);
}

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
  return "[mesh]\nfile = \"" + block(flight.dimension) +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\nlaw = \"" + flight.law +
         "\"\n[obstacle.floor]\ntype = \"plane\"\npoint = " + (plane ? "[0, -" : "[0, -") +
         std::to_string(flight.height) + (plane ? "]\nnormal = [0, 1]\n" : ", 0]\nnormal = [0, 1, 0]\n") +
         "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" + flight.more +
         "[initial]\ndisplacement = " + displacement + "\nvelocity = " + velocity + "\n[mass]\ntype = \"" +
         flight.mass + "\"\n[time]\nscheme = \"" + flight.scheme + "\"\n" +
         (flight.scheme == "newmark" ? "preset = \"trapezoidal\"\n" : "") + "step = " + std::to_string(flight.step) +
         "\nend = " + std::to_string(flight.steps * flight.step) + "\n";
}

std::string stretched(int dimension) {
  return dimension == 2 ? "[\"0.02*sin(5*x)\", \"0.02*sin(5*y)\"]"
                        : "[\"0.02*sin(5*x)\", \"0.02*sin(5*y)\", \"0.02*sin(4*z+x)\"]";
}
std::string spinning(int dimension) {
  return dimension == 2 ? "[\"0.3-2*(y-0.25)\", \"2*(x-0.5)\"]"
                        : "[\"0.3-2*(y-0.25)+(z-0.3)\", \"2*(x-0.5)-0.5*(z-0.3)\", \"0.5*(y-0.25)-(x-0.5)\"]";
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

/// Strains of 10⁻⁷, at which corrections shrink so fast that positions have converged before σ is known. (Displacements
/// of 10⁻⁵ have a rounding of 10⁻¹⁴ of those.)
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
        const std::string velocity = dimension == 2 ? "[\"0.3-2*(y-0.25)\", \"-0.5+2*(x-0.5)\"]"
                                                    : "[\"0.3-2*(y-0.25)\", \"-0.5+2*(x-0.5)\", \"0.2\"]";
        CaseRun run(case_of(flight, stretched(dimension), velocity));
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
    const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
    const auto number = [](double value) { return fmt::format("({:.17g})", value); };
    const std::string u = "0.02*sin(5*x)", v = "0.02*sin(5*y)", x = "(x+" + u + ")", y = "(y+" + v + ")";
    const std::string p = "(-2*(y-0.25))", q = "(2*(x-0.5)+0.3*x*y)";
    Flight flight{.scheme = scheme};
    CaseRun one(case_of(flight, "[\"" + u + "\", \"" + v + "\"]", "[\"" + p + "\", \"" + q + "\"]"));
    CaseRun other(case_of(flight,
                          "[\"" + number(c) + "*" + x + "-" + number(s) + "*" + y + "-x\", \"" + number(s) + "*" + x +
                              "+" + number(c) + "*" + y + "-y\"]",
                          "[\"" + number(c) + "*" + p + "-" + number(s) + "*" + q + "\", \"" + number(s) + "*" + p +
                              "+" + number(c) + "*" + q + "\"]"));
    one.run([] {});
    other.run([] {});
    const Matrix rotation = (Matrix(2, 2) << c, -s, s, c).finished();
    const Index nodes = one.problem().nodes.cols();
    const Points first = one.problem().nodes + one.state().displacement.reshaped(2, nodes);
    const Points second = other.problem().nodes + other.state().displacement.reshaped(2, nodes);
    EXPECT_LT((rotation * first - second).cwiseAbs().maxCoeff(), 1e-12) << scheme;
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
      CaseRun linear = run_law("linear"), finite = run_law(law);
      double force = 0.0, difference = 0.0;
      while (linear.session().step() && finite.session().step()) {
        force = std::max(force, linear.state().forces.normal_reaction.sum());
        difference = std::max(difference, std::abs(linear.state().forces.normal_reaction.sum() -
                                                   finite.state().forces.normal_reaction.sum()));
      }
      EXPECT_GT(force, 0.0);
      EXPECT_LT(difference, 1e-6 * force) << scheme << " " << law;
      const double size = linear.state().displacement.lpNorm<Eigen::Infinity>();
      EXPECT_LT((linear.state().displacement - finite.state().displacement).lpNorm<Eigen::Infinity>(), 1e-6 * size)
          << scheme << " " << law;
    }
  }
}

/// Halving the step divides the error of a flight by four.
TEST(FiniteStrain, IsOfSecondOrder) {
  for (const std::string scheme : {"reduced-kane", "mean-reaction", "newmark", "kane", "midpoint"}) {
    const bool has_inertia = scheme == "kane" || scheme == "midpoint";
    const auto end_of = [&](double step) {
      Flight flight{.scheme = scheme, .mass = has_inertia ? "consistent" : "equivalent", .step = step};
      CaseRun run(case_of(flight, "[\"0.02*(x-0.5)\", \"-0.01*(y-0.25)\"]", "[\"-2*(y-0.25)\", \"2*(x-0.5)\"]"));
      while (run.state().time < 0.016 * (1.0 - 1e-9)) run.session().step();
      return run.state().displacement;
    };
    const Vector coarse = end_of(4e-4), middle = end_of(2e-4), fine = end_of(1e-4);
    const double rate = (coarse - middle).norm() / (middle - fine).norm();
    EXPECT_GT(rate, 3.5) << scheme;
    EXPECT_LT(rate, 4.5) << scheme;
  }
}

}  // namespace finite_strain_test
}  // namespace ricochet
