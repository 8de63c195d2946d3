#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "ricochet/run/run_case.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "support/block_flight.hpp"
#include "support/case_run.hpp"
#include "support/motion_totals.hpp"
#include "support/same_snapshots.hpp"
#include "support/thrown_body.hpp"

/// @file The scheme semi-explicit at finite strain: its balances and its limit.
namespace ricochet::test_support::finite_explicit_test {

struct Flight {
  int dimension = 2;
  std::string law = "neo-hookean";
  double step = 0.002, height = 10.0, steps = 200.0;
  std::string more = {}, scheme = "semi-explicit";
  double poisson = 0.3;
};

/// A block of E = 100, ρ = 1 above a floor: waves cross a cell in about 0.01.
std::string case_of(const Flight& flight, const std::string& displacement, const std::string& velocity) {
  const bool plane = flight.dimension == 2;
  return "[mesh]\nfile = \"" + finite_block(flight.dimension, 0.15) +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = " +
         fmt::format("{}", flight.poisson) + "\nlaw = \"" + flight.law +
         "\"\n[obstacle.floor]\ntype = \"plane\"\npoint = " +
         fmt::format("[0, {:.17g}{}]\nnormal = [0, 1{}]\n", -flight.height, plane ? "" : ", 0", plane ? "" : ", 0") +
         "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" + flight.more +
         "[initial]\ndisplacement = " + displacement + "\nvelocity = " + velocity +
         "\n[mass]\ntype = \"equivalent-lumped\"\n[time]\nscheme = \"" + flight.scheme +
         fmt::format("\"\nstep = {:.17g}\nend = {:.17g}\n", flight.step, flight.steps * flight.step);
}

TEST(FiniteExplicit, FreeFlightKeepsMomenta) {
  for (const int dimension : {2, 3}) {
    for (const std::string law : {"neo-hookean", "mooney-rivlin", "saint-venant-kirchhoff"}) {
      std::string text = case_of({.dimension = dimension, .law = law}, stretched(dimension), spinning(dimension));
      if (law == "mooney-rivlin") {
        const std::string keys = "young = 100.0\npoisson = 0.3\n";
        text.replace(text.find(keys), keys.size(), "c10 = 12.0\nc01 = 7.0\nbulk_modulus = 83.0\n");
      }
      CaseRun run(text);
      const Momenta start(run);
      run.run([&] {
        const Momenta now(run);
        EXPECT_LT((now.linear - start.linear).norm(), 1e-12) << law;
        EXPECT_LT((now.angular - start.angular).norm(), 1e-12) << law;
      });
    }
  }
}

/// The energy oscillates by O(h²) and does not drift over 10⁴ steps; the account closes with the integration error of
/// the internal forces.
TEST(FiniteExplicit, TheEnergyOfALongFlightIsBounded) {
  double before = 0.0;
  for (const double step : {0.004, 0.002}) {
    CaseRun run(case_of({.step = step, .steps = 10000.0}, stretched(2), spinning(2)));
    const double start = energy_of(run);
    double of_first = 0.0, of_last = 0.0;
    const Momenta first(run);
    run.run([&] {
      double& largest = run.state().step < 1000 ? of_first : of_last;
      if (run.state().step < 1000 || run.state().step > 9000)
        largest = std::max(largest, std::abs(energy_of(run) - start));
      if (run.state().step % 500 != 0) return;
      const Energies energies = run.simulation().account().energies(run.state());
      EXPECT_NEAR(run.simulation().account().residual(energies), 0.0, 1e-11 * start);
      const Momenta now(run);
      EXPECT_LT((now.angular - first.angular).norm(), 1e-11);
    });
    std::printf("step %.4f: energy off by %.3e of it in the first 1000 steps, %.3e in the last\n", step,
                of_first / start, of_last / start);
    EXPECT_LT(of_last, 1.5 * of_first);
    // For a vibration (h²/8) AᵀMA is at most (h/h_c)² of the elastic energy.
    EXPECT_LT(of_first, std::pow(step / run.scheme().critical_step(), 2) * start);
    if (before > 0.0) {
      EXPECT_NEAR(before / of_first, 4.0, 1.0);
    }
    before = of_first;
  }
}

TEST(FiniteExplicit, IsOfSecondOrderInFlight) {
  expect_second_order([](double step, const std::string& displacement,
                         const std::string& velocity) { return case_of({.step = step}, displacement, velocity); },
                      "semi-explicit");
}

TEST(FiniteExplicit, SmallMotionsAreLinear) {
  for (const int dimension : {2, 3}) {
    for (const std::string law : {"neo-hookean", "saint-venant-kirchhoff"}) {
      for (const std::string friction : {"", "friction = 0.4\n"}) {
        const auto run_law = [&](const std::string& name) {
          Flight flight{.dimension = dimension, .law = name, .height = 1e-9, .more = friction};
          return CaseRun(case_of(flight,
                                 dimension == 2 ? "[\"1e-9*sin(5*x)\", \"1e-9*sin(5*y)\"]"
                                                : "[\"1e-9*sin(5*x)\", \"1e-9*sin(5*y)\", \"0\"]",
                                 dimension == 2 ? "[\"2e-9\", \"-1e-8\"]" : "[\"2e-9\", \"-1e-8\", \"0\"]"));
        };
        expect_same_motion(run_law("linear"), run_law(law), law + friction);
      }
    }
  }
}

/// Contact nodes are in equilibrium on the floor, both momenta change by the impulses, the account closes, contact
/// works ½(r₀·g₁ − r₁·g₀) a step, and the energy hardly rises.
TEST(FiniteExplicit, BouncingBalances) {
  for (const int dimension : {2, 3}) {
    for (const std::string friction : {"", "friction = 0.4\n"}) {
      Flight flight{.dimension = dimension, .height = 0.02, .steps = 400.0, .more = friction};
      CaseRun run(case_of(flight, stretched(dimension), falling(dimension)));
      const double start = energy_of(run);
      double largest_force = 0.0, most = start, contact_work = 0.0;
      const Momenta first(run);
      MomentumAccount momentum(run.problem(), run.scheme(), run.state());
      Vector gap_before, gap, reaction_before = run.state().forces.normal_reaction;
      run.problem().gaps(run.state().displacement, 0.0, gap_before);
      run.run(
          [&] {
            momentum.enter_step(run.state());
            const std::string what = fmt::format("{}d {} step {}", dimension, friction, run.state().step);
            const Energies energies = run.simulation().account().energies(run.state());
            EXPECT_NEAR(run.simulation().account().residual(energies), 0.0, 1e-12 * start) << what;
            const Momenta now(run);
            EXPECT_LT((now.linear - first.linear - momentum.impulse().force).norm(), 1e-12) << what;
            EXPECT_LT((now.angular - first.angular - momentum.impulse().moment).norm(), 1e-12) << what;
            run.problem().gaps(run.state().displacement, run.state().time, gap);
            EXPECT_GT(gap.minCoeff(), -1e-12) << what;
            const Vector& reaction = run.state().forces.normal_reaction;
            EXPECT_LT(std::abs(reaction.dot(gap)), 1e-12) << what;
            contact_work += 0.5 * (reaction_before.dot(gap) - reaction.dot(gap_before));
            EXPECT_NEAR(run.simulation().account().works().contact, contact_work, 1e-12 * start) << what;
            EXPECT_GT(run.state().newton_iterations, 0);
            reaction_before = reaction;
            gap_before = gap;
            largest_force = std::max(largest_force, reaction.sum());
            most = std::max(most, energy_of(run));
          },
          false);
      std::printf("%dd %s: energy rose to %.6f of that of the start, contact worked %.2e of it\n", dimension,
                  friction.c_str(), most / start, contact_work / start);
      EXPECT_GT(largest_force, 0.1);
      EXPECT_LT(most, 1.01 * start);
      EXPECT_LT(std::abs(contact_work), 5e-3 * start);
    }
  }
}

/// With gravity, friction and damping the impulses include all forces.
TEST(FiniteExplicit, MomentaChangeByTheImpulsesOfAllForces) {
  std::string text = case_of({.height = 0.02, .steps = 300.0, .more = "friction = 0.3\n"}, stretched(2), falling(2));
  text.insert(text.find("[obstacle"), "damping = { mass = 0.3 }\n");
  text.insert(text.find("[initial]"), "[load]\ngravity = [1.0, -3.0]\n");
  CaseRun run(text);
  const Momenta first(run);
  MomentumAccount momentum(run.problem(), run.scheme(), run.state());
  double start = energy_of(run);
  run.run(
      [&] {
        momentum.enter_step(run.state());
        const Momenta now(run);
        EXPECT_LT((now.linear - first.linear - momentum.impulse().force).norm(), 1e-12);
        EXPECT_LT((now.angular - first.angular - momentum.impulse().moment).norm(), 1e-12);
        const Energies energies = run.simulation().account().energies(run.state());
        EXPECT_NEAR(run.simulation().account().residual(energies), 0.0, 1e-12 * std::abs(start));
      },
      false);
}

/// The balances also hold for axisymmetric bodies and on a ball.
TEST(FiniteExplicit, RingsAndBallsBalance) {
  std::string ring = case_of({.height = 0.02, .steps = 300.0, .more = "friction = 0.4\n"},
                             "[\"0.03*x*sin(3*y)\", \"0.02*sin(5*y)\"]", "[\"0\", \"-0.5\"]");
  ring.insert(ring.find("[[material]]"), "plane = \"axisymmetric\"\n");
  std::string ball = case_of({.height = 0.02, .steps = 300.0, .more = "friction = 0.4\n"}, stretched(2), falling(2));
  const std::size_t from = ball.find("type = \"plane\""), to = ball.find("[[contact]]");
  ball.replace(from, to - from, "type = \"sphere\"\ncentre = [0.4, -3.01]\nradius = 3.0\nside = \"outside\"\n");
  for (const std::string& text : {ring, ball}) {
    CaseRun run(text);
    const double start = energy_of(run);
    double largest_force = 0.0;
    run.run([&] {
      const Energies energies = run.simulation().account().energies(run.state());
      EXPECT_NEAR(run.simulation().account().residual(energies), 0.0, 1e-12 * start);
      EXPECT_LT(energy_of(run), 1.01 * start);
      largest_force = std::max(largest_force, run.state().forces.normal_reaction.sum());
    });
    EXPECT_GT(largest_force, 0.1);
  }
}

/// With fine steps, the motion approaches that of reduced-kane with the same mass: differences are of second order
/// without friction, and of first order with it, as the reactions of the end act there.
TEST(FiniteExplicit, ConvergesToReducedKane) {
  for (const std::string friction : {"", "friction = 0.4\n"}) {
    double before = INFINITY;
    for (const double step : {0.002, 0.001, 0.0005}) {
      const auto run_scheme = [&](const std::string& scheme) {
        return CaseRun(case_of({.step = step, .height = 0.02, .steps = 0.5 / step, .more = friction, .scheme = scheme},
                               stretched(2), falling(2)));
      };
      CaseRun left = run_scheme("semi-explicit"), right = run_scheme("reduced-kane");
      double difference = 0.0, of_left = 0.0, of_right = 0.0;
      while (left.session().step() && right.session().step()) {
        difference =
            std::max(difference, (left.state().displacement - right.state().displacement).lpNorm<Eigen::Infinity>());
        of_left += left.state().forces.normal_reaction.sum();
        of_right += right.state().forces.normal_reaction.sum();
      }
      std::printf("step %g %s: displacements differ by %.2e, impulses by %.2e of them\n", step, friction.c_str(),
                  difference, of_left / of_right - 1.0);
      EXPECT_LT(difference, (friction.empty() ? 0.4 : 0.6) * before);
      EXPECT_NEAR(of_left / of_right, 1.0, 0.02);
      before = difference;
    }
    EXPECT_LT(before, 5e-3);
  }
}

/// The critical step decreases and is recomputed repeatedly, and the factor of the contact nodes is renewed.
TEST(FiniteExplicit, ResumesToTheSameBits) {
  const std::string bounce =
      case_of({.step = 0.004, .height = 0.02, .steps = 300.0, .more = "friction = 0.3\n"},
              "[\"0.05*sin(5*x)\", \"0.05*sin(5*y)\"]", "[\"0.3-6*(y-0.25)\", \"-2+6*(x-0.5)\"]");
  std::string loaded = bounce;
  loaded.insert(loaded.find("[obstacle"), "damping = { mass = 0.3 }\n");
  loaded.insert(loaded.find("[initial]"), "[load]\ngravity = [1.0, -3.0]\n");
  for (const std::string& text : {bounce, loaded}) {
    CaseRun run(text);
    const double critical_at_start = run.scheme().critical_step();
    std::map<long, Snapshot> snapshots;
    run.run([&] {
      const long step = run.state().step;
      if (step % 37 == 0) run.simulation().save(snapshots[step]);
    });
    Snapshot end;
    run.simulation().save(end);
    EXPECT_LT(run.scheme().critical_step(), 0.95 * critical_at_start);
    for (const auto& [step, snapshot] : snapshots) {
      const std::unique_ptr<Scheme> scheme = make_scheme(run.input().time);
      Simulation resumed(run.problem(), *scheme, snapshot, step_solver_options(run.input()));
      while (resumed.state().step < run.state().step) resumed.advance();
      Snapshot found;
      resumed.save(found);
      expect_same(end, found);
      EXPECT_EQ(scheme->critical_step(), run.scheme().critical_step());
    }
  }
}

}  // namespace ricochet::test_support::finite_explicit_test
