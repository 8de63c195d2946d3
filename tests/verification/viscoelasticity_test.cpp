#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ricochet/base/error.hpp"
#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "support/block_flight.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"
#include "support/motion_totals.hpp"
#include "support/same_snapshots.hpp"
#include "support/viscous_block.hpp"

/// @file Viscoelastic stress: the balances of every step.
namespace ricochet::test_support::viscoelasticity_test {

using namespace viscous;

struct Motion {
  int dimension = 2;
  std::string scheme = "reduced-kane", law = "neo-hookean", more = {}, time = {};
  double step = 0.01, height = 10.0;
  std::string displacement = {}, velocity = {};
  std::vector<RelaxationBranch> branches{{0.5, 0.05}, {1.5, 0.4}};
};

/// A block above a floor.
std::string case_of(const Motion& motion) {
  const bool plane = motion.dimension == 2;
  const auto or_zero = [&](const std::string& value) {
    return !value.empty() ? value : plane ? "[\"0\", \"0\"]" : "[\"0\", \"0\", \"0\"]";
  };
  return "[mesh]\nfile = \"" + block(motion.dimension) + "\"\n" + material(motion.law, motion.branches) +
         fmt::format("[obstacle.floor]\ntype = \"plane\"\npoint = [0, {}{}]\nnormal = [0, 1{}]\n", -motion.height,
                     plane ? "" : ", 0", plane ? "" : ", 0") +
         "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" + motion.more +
         "[initial]\ndisplacement = " + or_zero(motion.displacement) + "\nvelocity = " + or_zero(motion.velocity) +
         fmt::format("\n[time]\nscheme = \"{}\"\nstep = {}\nend = {}\n{}", motion.scheme, motion.step,
                     200.0 * motion.step, motion.time);
}

const std::vector<std::string>& schemes() {
  static const std::vector<std::string> all{"reduced-kane", "mean-reaction", "reduced-midpoint"};
  return all;
}

/// Expects the balances of every step of a body that bounces or flies.
void expect_balances(const Motion& motion, double least_force) {
  CaseRun run(case_of(motion));
  const double start = energy_of(run);
  double before = start, viscous = 0.0, numerical = 0.0, largest_force = 0.0;
  const Momenta first(run);
  MomentumAccount momentum(run.problem(), run.scheme(), run.state());
  // Called for each part of a subdivided step as well.
  const auto check = [&](const State& state) {
    const std::string what = fmt::format("{} {} {} {}D, {} step {}", motion.scheme, motion.more, motion.time,
                                         motion.dimension, motion.branches.front().time, state.step);
    const double energy = energy_of(run);
    EXPECT_LT(energy, before + 1e-13 * start) << what;
    before = energy;
    EnergyAccount& account = run.simulation().account();
    const Works& works = account.works();
    EXPECT_GE(works.viscous_dissipation, viscous) << what;
    viscous = works.viscous_dissipation;
    EXPECT_GE(works.numerical_dissipation, numerical - 1e-14 * start) << what;
    numerical = works.numerical_dissipation;
    EXPECT_LT(std::abs(works.integration_error), 1e-11 * start) << what;
    EXPECT_NEAR(account.residual(account.energies(state)), 0.0, 5e-13 * start) << what;
    if (motion.scheme != "reduced-kane") {
      EXPECT_NEAR(energy + viscous, start, 1e-12 * start) << what;
    }
    momentum.enter_step(state);
    const Momenta now(run);
    EXPECT_LT((now.linear - first.linear - momentum.impulse().force).norm(), 1e-12) << what;
    EXPECT_LT((now.angular - first.angular - momentum.impulse().moment).norm(), 1e-11) << what;
    largest_force = std::max(largest_force, state.forces.normal_reaction.sum());
    Vector gap;
    run.problem().gaps(state.displacement, state.time, gap);
    EXPECT_GT(gap.minCoeff(), -1e-12) << what;
  };
  for (int step = 0; step < 100; ++step) run.simulation().advance(check);
  EXPECT_GE(largest_force, least_force) << motion.scheme;
  EXPECT_GT(viscous, 0.01 * start) << motion.scheme;
}

TEST(Viscoelasticity, FlightsDissipateAndKeepMomenta) {
  for (const int dimension : {2, 3}) {
    for (const std::string& scheme : schemes()) {
      expect_balances({.dimension = dimension,
                       .scheme = scheme,
                       .displacement = stretched(dimension),
                       .velocity = dimension == 2 ? "[\"0.3-2*(y-0.25)+x\", \"2*(x-0.5)\"]"
                                                  : "[\"0.3-2*(y-0.25)+(z-0.3)+x\", \"2*(x-0.5)-0.5*(z-0.3)\", "
                                                    "\"0.5*(y-0.25)-(x-0.5)\"]"},
                      0.0);
    }
  }
}

TEST(Viscoelasticity, BouncesBalance) {
  for (const int dimension : {2, 3}) {
    for (const std::string& scheme : schemes()) {
      for (const std::string more : {"", "friction = 0.4\n"}) {
        if (!more.empty() && scheme != "reduced-kane") continue;
        expect_balances({.dimension = dimension,
                         .scheme = scheme,
                         .more = more,
                         .height = 0.05,
                         .displacement = stretched(dimension),
                         .velocity = falling(dimension)},
                        0.1);
      }
    }
  }
}

/// Steps of every length relative to the relaxation times, branches stiffer than the law, and every kind of reaction.
TEST(Viscoelasticity, BouncesBalanceWhateverTheTimes) {
  for (const double time : {1e-5, 1e-3, 0.01, 0.1, 10.0}) {
    for (const std::string more : {"", "friction = 0.4\n"}) {
      for (const std::string weight : {"adaptive", "end"}) {
        expect_balances({.more = more,
                         .time = "reaction_weight = \"" + weight + "\"\n",
                         .height = 0.05,
                         .displacement = stretched(2),
                         .velocity = falling(2),
                         .branches = {{5.0, time}, {1.0, 0.05}}},
                        0.1);
      }
    }
  }
}

TEST(Viscoelasticity, AxisymmetricBodiesBalance) {
  Motion motion{.scheme = "mean-reaction",
                .height = 0.05,
                .displacement = "[\"0.03*x*sin(3*y)\", \"0.02*sin(5*y)\"]",
                .velocity = "[\"0\", \"-0.5\"]"};
  std::string text = case_of(motion);
  text.insert(text.find("[[material]]"), "plane = \"axisymmetric\"\n");
  CaseRun run(text);
  const double start = energy_of(run);
  run.run([&] {
    EnergyAccount& account = run.simulation().account();
    EXPECT_NEAR(energy_of(run) + account.works().viscous_dissipation, start, 1e-11 * start);
  });
  EXPECT_GT(run.simulation().account().works().viscous_dissipation, 0.01 * start);
}

TEST(Viscoelasticity, AdaptiveStepsBalance) {
  Motion motion{.height = 0.05, .displacement = stretched(2), .velocity = falling(2)};
  std::string text = case_of(motion);
  text.replace(text.find("step = 0.01"), 11, "step = \"adaptive\"\ntolerance = 1e-3\nlargest = 0.02\nsmallest = 1e-4");
  CaseRun run(text);
  const double start = energy_of(run);
  run.run([&] {
    EnergyAccount& account = run.simulation().account();
    EXPECT_NEAR(account.residual(account.energies(run.state())), 0.0, 1e-12 * start);
  });
  ASSERT_NE(run.simulation().control(), nullptr);
  EXPECT_GT(run.simulation().control()->counts().refused, 0);
}

/// A rigid spin has no stress and no dissipation, however large the rotation in a step.
TEST(Viscoelasticity, ARigidSpinDissipatesNothing) {
  CaseRun run(case_of({.step = 500.0, .height = 1e6, .velocity = "[\"-1e-4*(y-0.25)\", \"1e-4*(x-0.5)\"]"}));
  const double start = energy_of(run);
  run.run([] {});
  // Only ρω²L²/E stretches the body.
  EXPECT_LT(run.simulation().account().works().viscous_dissipation, 1e-8 * start);
  EXPECT_NEAR(energy_of(run), start, 1e-8 * start);
}

/// Superposed rotations of the whole motion change only the positions.
TEST(Viscoelasticity, AMotionThatIsTurnedIsTheSameMotion) {
  const auto of_motion = [](const std::string& displacement, const std::string& velocity) {
    return case_of({.displacement = displacement, .velocity = velocity});
  };
  EXPECT_LT(expect_turned_motion(of_motion, "(-2*(y-0.25)+x)", "(2*(x-0.5)+0.3*x*y)"), 1e-12);
}

/// Branches that do not relax during a run are springs parallel to the law, and those that relax at once vanish.
TEST(Viscoelasticity, ItsLimitsAreTwoElasticBodies) {
  const double g = 0.8;
  const std::string stiff =
      fmt::format("mu = {:.17g}\nlambda = {:.17g}\n", shear * (1.0 + g), lambda - 2.0 / 3.0 * g * shear);
  for (const bool bounces : {false, true}) {
    const auto end_of = [&](const std::string& constants, const std::vector<RelaxationBranch>& branches,
                            const std::string& scheme) {
      std::string text = case_of({.scheme = scheme,
                                  .law = "saint-venant-kirchhoff",
                                  .time = bounces ? "reaction_weight = \"end\"\n" : "",
                                  .height = bounces ? 0.05 : 10.0,
                                  .velocity = "[\"0.3-2*(y-0.25)+x\", \"-0.5+2*(x-0.5)\"]",
                                  .branches = branches});
      if (!constants.empty()) {
        const std::string given = fmt::format("young = {}\npoisson = {}\n", young, poisson);
        text.replace(text.find(given), given.size(), constants);
      }
      CaseRun run(text + "[solver]\nnewton_tolerance = 1e-13\n");
      run.run([] {});
      return run.state().displacement;
    };
    for (const std::string& scheme : schemes()) {
      if (bounces && scheme != "reduced-kane") continue;
      const Vector spring = end_of("", {{0.3, 1e13}, {0.5, 1e14}}, scheme) - end_of(stiff, {}, scheme);
      EXPECT_LT(spring.lpNorm<Eigen::Infinity>(), 1e-11) << scheme;
      const Vector nothing = end_of("", {{0.3, 1e-13}, {0.5, 1e-14}}, scheme) - end_of("", {}, scheme);
      EXPECT_LT(nothing.lpNorm<Eigen::Infinity>(), 1e-11) << scheme;
    }
  }
}

/// Halving the step divides the error of a flight by four.
TEST(Viscoelasticity, IsOfSecondOrder) {
  for (const std::string& scheme : schemes()) {
    const auto of_step = [&](double step, const std::string& displacement, const std::string& velocity) {
      return case_of({.scheme = scheme,
                      .step = step,
                      .displacement = displacement,
                      .velocity = velocity,
                      .branches = {{0.5, 0.003}, {1.0, 0.02}}});
    };
    expect_second_order(of_step, scheme);
  }
}

/// The more of the stiffness relaxes, the slower a dropped disc rebounds.
TEST(Viscoelasticity, RestitutionFallsWithTheBranches) {
  const std::string disc = mesh_geometry("viscous-disc",
                                         "Disk(1) = {0, 0.5, 0, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                         "Physical Curve(\"rim\") = {1};\n",
                                         0.12, 1);
  double before = 1.0;
  for (const double modulus : {0.0, 0.1, 0.3, 1.0}) {
    std::vector<RelaxationBranch> branches;
    if (modulus > 0.0) branches.push_back({modulus, 0.1});
    CaseRun run("[mesh]\nfile = \"" + disc + "\"\n" + material("neo-hookean", branches) +
                "[obstacle.floor]\ntype = \"plane\"\npoint = [0, -0.02]\nnormal = [0, 1]\n[[contact]]\ngroup = "
                "\"rim\"\nobstacle = \"floor\"\n[initial]\nvelocity = [\"0\", \"-1\"]\n[time]\nstep = 0.01\nend = 1\n");
    const double mass = run.problem().mass.quadratic_form(Vector::Ones(run.problem().dof_count())) / 2.0;
    run.run([] {});
    EXPECT_TRUE(run.state().forces.normal_reaction.isZero(0.0));
    const double restitution = Momenta(run).linear[1] / mass;
    EXPECT_GT(restitution, 0.1);
    EXPECT_LT(restitution, modulus > 0.0 ? before - 0.02 : before) << modulus;
    before = restitution;
  }
}

/// A static start is fully relaxed: under its weight the body neither moves nor relaxes further.
TEST(Viscoelasticity, AStaticStartIsRelaxed) {
  const std::string text = "[mesh]\nfile = \"" + block(2) + "\"\n" + material("neo-hookean", {{5.0, 0.05}}) +
                           "[load]\ngravity = [0, -50]\n[initial]\ndisplacement = \"static\"\n[[support]]\ngroup = "
                           "\"bottom\"\ncomponents = [\"x\", \"y\"]\nvalue = 0\n[time]\nstep = 0.01\nend = 1\n";
  CaseRun run(text);
  const Vector start = run.state().displacement;
  EXPECT_GT(start.lpNorm<Eigen::Infinity>(), 1e-3);
  run.run([] {});
  EXPECT_LT((run.state().displacement - start).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_LT(run.simulation().account().works().viscous_dissipation, 1e-12);
}

TEST(Viscoelasticity, GoesOnFromACheckpointWithTheSameBits) {
  for (const std::string more : {"", "friction = 0.4\n"}) {
    CaseRun run(case_of({.more = more, .height = 0.05, .displacement = stretched(2), .velocity = falling(2)}));
    Snapshot snapshot, end, again;
    run.run([&] {
      if (run.state().step == 23) run.simulation().save(snapshot);
    });
    run.simulation().save(end);
    const std::unique_ptr<Scheme> scheme = make_scheme(run.input().time);
    Simulation resumed(run.problem(), *scheme, snapshot, step_solver_options(run.input()),
                       step_control_options(run.input().time));
    while (resumed.state().step < run.state().step) resumed.advance();
    resumed.save(again);
    expect_same(end, again);
    EXPECT_GT(end.reals("state.internal_strain").size(), 0);
    snapshot.save("state.internal_strain", Vector(Vector::Zero(1)));
    EXPECT_THROW(Simulation(run.problem(), *scheme, snapshot), Error);
  }
}

/// Schemes without viscoelasticity refuse it.
TEST(Viscoelasticity, OtherSchemesRefuseIt) {
  for (const std::string scheme : {"newmark", "generalized-alpha", "midpoint", "kane"}) {
    std::string text = case_of({.scheme = scheme});
    if (scheme == "newmark") text += "preset = \"trapezoidal\"\n";
    if (scheme == "midpoint" || scheme == "kane") text += "[mass]\ntype = \"consistent\"\n";
    expect_error({"does not support viscoelastic branches"}, [&] { CaseRun run(text); });
  }
}

}  // namespace ricochet::test_support::viscoelasticity_test
