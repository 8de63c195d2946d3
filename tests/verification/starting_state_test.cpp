#include <gtest/gtest.h>

#include <cmath>

#include "support/case_run.hpp"
#include "support/errors.hpp"
#include "support/thrown_body.hpp"

// The state at t = 0: static equilibrium with contact, consistent accelerations, nodes in contact at the start.

namespace ricochet::test_support::starting_state_test {

std::string block_mesh(double gap) {
  return mesh_geometry("block",
                       "Rectangle(1)={0," + std::to_string(gap) +
                           ",0,2,1}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1}; "
                           "Physical Curve(\"left\")={4}; Physical Curve(\"top\")={3};",
                       0.25, 1);
}

std::string block_case(double gap, const std::string& mass, const std::string& rest) {
  return "[mesh]\nfile = \"" + block_mesh(gap) +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 2.0\nyoung = 1000.0\npoisson = 0.3\n"
         "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
         "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n[load]\ngravity = [0.0, -10.0]\n[mass]\ntype = \"" +
         mass + "\"\n" + rest;
}

const std::string newmark = "[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 1e-3\nend = 0.2\n";
constexpr double weight = 2.0 * 2.0 * 10.0;

TEST(StartingState, StaticEquilibriumStaysAtRestWithEveryMassAndScheme) {
  for (const char* scheme :
       {"scheme = \"midpoint\"\n", "scheme = \"klr-conserving\"\n", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n",
        "scheme = \"semi-explicit\"\n", "scheme = \"reduced-kane\"\n", "scheme = \"mean-reaction\"\n",
        "scheme = \"reduced-midpoint\"\n"}) {
    for (const char* mass : {"consistent", "lumped", "equivalent", "equivalent-lumped"}) {
      const std::string name = std::string(scheme).substr(10, std::string(scheme).find('"', 10) - 10);
      const std::vector<std::string> taken = masses_of(name);
      if (std::ranges::find(taken, mass) == taken.end()) continue;
      // An unsupported body starts above the floor: its equilibrium is found on the floor.
      CaseRun run(block_case(
          0.01, mass,
          "[initial]\ndisplacement = \"static\"\n[time]\n" + std::string(scheme) + "step = 1e-3\nend = 0.1\n"));
      const Vector start = run.state().displacement;
      double drift = 0.0, force_error = 0.0;
      run.run([&] {
        drift = std::max(drift, (run.state().displacement - start).lpNorm<Eigen::Infinity>());
        if (run.state().step > 0)
          force_error = std::max(force_error, std::abs(run.state().forces.normal_reaction.sum() - weight));
      });
      EXPECT_LT(drift, 1e-12) << scheme << mass;
      EXPECT_LT(force_error, 1e-8 * weight) << scheme << mass;
      Vector gap;
      run.problem().gaps(start, 0.0, gap);
      EXPECT_GT(gap.minCoeff(), -1e-15) << "no interpenetration at the start";
    }
  }
}

TEST(StartingState, StaticEquilibriumUnderItsOwnWeightIsThatOfTheColumn) {
  // Laterally held (x), ν = 0.3: uniaxial strain, σ_yy = −ρ g (H − y), pressure ρ g H on the floor.
  const std::string mesh = mesh_geometry("column",
                                         "Rectangle(1)={0,0,0,2,1}; Physical Surface(\"body\")={1}; Physical "
                                         "Curve(\"bottom\")={1}; Physical Curve(\"sides\")={2,4};",
                                         0.25, 2);
  CaseRun run("[mesh]\nfile = \"" + mesh +
              "\"\ndegree = 2\n[[material]]\ngroup = \"body\"\ndensity = 2.0\nyoung = 1000.0\npoisson = 0.3\n"
              "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n[[contact]]\ngroup = "
              "\"bottom\"\nobstacle = \"floor\"\n"
              "[[support]]\ngroup = \"sides\"\ncomponents = [\"x\"]\nvalue = 0.0\n[load]\nbody_force = [0.0, "
              "-20.0]\n[mass]\ntype = \"consistent\"\n"
              "[initial]\ndisplacement = \"static\"\n" +
              newmark);
  const Vector& u = run.state().displacement;
  const double modulus = 1000.0 * (1.0 - 0.3) / ((1.0 + 0.3) * (1.0 - 0.6));
  for (Index i = 0; i < run.problem().nodes.cols(); ++i) {
    const double y = run.problem().nodes(1, i);
    EXPECT_NEAR(u[2 * i + 1], -20.0 / modulus * (y - 0.5 * y * y), 1e-11);
    EXPECT_NEAR(u[2 * i], 0.0, 1e-11);
  }
  run.simulation().advance();
  const Vector pressure = run.problem().contact.pressure_recovery * run.state().forces.normal_reaction;
  for (Index i = 0; i < pressure.size(); ++i) EXPECT_NEAR(pressure[i], 20.0, 1e-7) << "uniform pressure on degree 2";
}

TEST(StartingState, SaysWhenThereIsNoEquilibrium) {
  expect_error({"there is no equilibrium", "(2, "}, [&] {
    CaseRun run(block_case(
        0.01, "equivalent",
        "[[traction]]\ngroup = \"top\"\nvalue = [1.0, 0.0]\n[initial]\ndisplacement = \"static\"\n" + newmark));
  });
}

/// Residual of M A + C V + K U − L − Gᵀr on unsupported dofs, relative to the forces.
double momentum_residual(CaseRun& run) {
  const SemidiscreteProblem& problem = run.problem();
  const State& state = run.state();
  Vector load, internal;
  problem.loads.total(state.time, load);
  problem.internal_force->evaluate(state.displacement, internal);
  Vector residual = problem.mass.to_sparse() * state.acceleration + internal - load;
  if (problem.has_damping()) residual += problem.damping.matrix() * state.velocity;
  state.forces.rows->add_force(-state.forces.normal_reaction, Vector(), residual);
  for (const Index dof : problem.supports.dofs()) residual[dof] = 0.0;
  return residual.lpNorm<Eigen::Infinity>() / (load.lpNorm<Eigen::Infinity>() + internal.lpNorm<Eigen::Infinity>());
}

TEST(StartingState, SatisfiesTheMomentumEquationWithEveryMass) {
  for (const char* mass : {"consistent", "lumped", "equivalent"}) {
    CaseRun run(block_case(0.0, mass,
                           "[[support]]\ngroup = \"left\"\ncomponents = [\"x\"]\nvalue = \"0.1*t*t\"\n[initial]\n"
                           "displacement = [\"0.01*x*y\", \"0.02*x*x\"]\nvelocity = [\"0.1*y\", \"0\"]\n" +
                               newmark));
    EXPECT_LT(momentum_residual(run), 1e-12) << mass;
    EXPECT_GE(run.state().forces.normal_reaction.minCoeff(), 0.0);
    for (const Index dof : run.problem().massless_dofs) EXPECT_EQ(run.state().acceleration[dof], 0.0);
    // The support moves as 0.1 t²: velocity 0 and acceleration 0.2 from the first values of the expression.
    const Index dof = run.problem().supports.dofs().front();
    if (!run.problem().has_singular_mass() || run.problem().is_massless[std::size_t(dof)] == 0) {
      EXPECT_NEAR(run.state().acceleration[dof], 0.2, 1e-9);
    }
    EXPECT_NEAR(run.state().velocity[dof], 0.0, 1e-12);
  }
}

TEST(StartingState, RestingNodesCarryTheWeightFromTheStart) {
  for (const char* mass : {"consistent", "lumped"}) {
    CaseRun run(block_case(0.0, mass, newmark));  // undeformed, at rest on the floor, gravity starts to act
    const Vector acceleration = run.problem().contact.rows->gap_operator * run.state().acceleration;
    EXPECT_GE(acceleration.minCoeff(), -1e-12 * 10.0) << "nothing accelerates into the floor";
    EXPECT_GT(run.state().forces.normal_reaction.sum(), 0.0);
  }
}

/// An unstrained block rotates by ω = 1 about the centre of a bowl, radius 5, that its two lower corners touch: the
/// bowl keeps them on the circle, with the force m ω² 5 of a lumped mass each, and no force acts on other nodes.
TEST(StartingState, ReactionsKeepMovingNodesOnACurvedObstacle) {
  const std::string mesh = mesh_geometry(
      "block_in_bowl", "Rectangle(1)={-3,1,0,6,2}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1};",
      1.0, 1);
  CaseRun run("[mesh]\nfile = \"" + mesh +
              "\"\n[[material]]\ngroup = \"body\"\ndensity = 2.0\nyoung = 1000.0\npoisson = 0.3\n"
              "[obstacle.bowl]\ntype = \"sphere\"\ncentre = [0.0, 5.0]\nradius = 5.0\nside = \"inside\"\n"
              "[[contact]]\ngroup = \"bottom\"\nobstacle = \"bowl\"\n[mass]\ntype = \"lumped\"\n"
              "[initial]\nvelocity = [\"5-y\", \"x\"]\n" +
              newmark);
  const SemidiscreteProblem& problem = run.problem();
  const Vector mass = problem.mass.diagonal();
  Vector expected = Vector::Zero(problem.dof_count());
  double force = 0.0;
  for (Index i = 0; i < problem.nodes.cols(); ++i) {
    const Eigen::Vector2d to_centre = Eigen::Vector2d(0.0, 5.0) - problem.nodes.col(i).head<2>();
    if (to_centre.norm() < 5.0 - 1e-9) continue;
    expected.segment<2>(2 * i) = to_centre;
    force += 5.0 * mass[2 * i];
  }
  EXPECT_GT(force, 0.0);
  EXPECT_EQ((expected.array() != 0.0).count(), 4) << "two corners";
  // The second difference over h = 1e-3 errs by (ωh)²/4.
  EXPECT_LT((run.state().acceleration - expected).lpNorm<Eigen::Infinity>(), 1e-6 * 5.0);
  EXPECT_NEAR(run.state().forces.normal_reaction.sum(), force, 1e-6 * force);
}

TEST(StartingState, ABodyThatIsStruckAtOnceHasNoReactionYet) {
  CaseRun run(block_case(0.0, "consistent", "[initial]\nvelocity = [0.0, -1.0]\n" + newmark));
  EXPECT_EQ(run.state().forces.normal_reaction.sum(), 0.0);
  run.simulation().advance();
  EXPECT_GT(run.state().forces.normal_reaction.sum(), 0.0);
}

TEST(StartingState, KlrConservingRefusesAMassWithoutInertiaOnContactNodes) {
  expect_error({"needs inertia on the contact nodes"}, [&] {
    CaseRun run(block_case(0.01, "equivalent", "[time]\nscheme = \"klr-conserving\"\nstep = 1e-3\nend = 0.1\n"));
  });
}

/// A strip held at its left end, loaded by its weight: thickness and stiffness ratio make the iteration hard.
double static_tip(double length, double thickness, double young, double stiff_young) {
  const std::string t = std::to_string(thickness), half = std::to_string(0.5 * length);
  const std::string mesh =
      mesh_geometry("slender",
                    "Rectangle(1)={0,0,0," + half + "," + t + "}; Rectangle(2)={" + half + ",0,0," + half + "," + t +
                        "}; BooleanFragments{Surface{1};Delete;}{Surface{2};Delete;} Physical Surface(\"near\")={1}; "
                        "Physical Surface(\"far\")={2}; l() = Curve In BoundingBox{-1e-3,-1,-1,1e-3,1,1}; Physical "
                        "Curve(\"left\")={l()};",
                    0.5 * thickness, 2);
  const auto material = [](const std::string& name, double e) {
    return "[[material]]\ngroup = \"" + name + "\"\ndensity = 1.0\npoisson = 0.0\nyoung = " + std::to_string(e) + "\n";
  };
  CaseRun run("[mesh]\nfile = \"" + mesh + "\"\ndegree = 2\nplane = \"stress\"\n" + material("near", young) +
              material("far", stiff_young) +
              "[[support]]\ngroup = \"left\"\ncomponents = [\"x\", \"y\"]\nvalue = 0.0\n[load]\ngravity = [0.0, -1.0]\n"
              "[initial]\ndisplacement = \"static\"\n[mass]\ntype = \"consistent\"\n" +
              newmark);
  return run.state().displacement.minCoeff();
}

TEST(StartingState, StaticEquilibriumOfSlenderAndOfUnevenBodies) {
  // Euler–Bernoulli cantilever under its weight: w = q L⁴ / 8EI, q = ρ g t, I = t³/12; shear adds of the order (t/L)².
  const double thickness = 0.02, young = 1e6;
  const double beam = 1.5 / (young * thickness * thickness);
  EXPECT_NEAR(static_tip(1.0, thickness, young, young), -beam, 2e-3 * beam);
  // The outer half is a million times stiffer: it only rotates. Inner half with moment M(x) = q(L−x)²/2 up to L/2, then
  // straight.
  const double half = 0.5, q = thickness, inertia = young * thickness * thickness * thickness / 12.0;
  const auto power = [](double x, int n) { return std::pow(x, n); };
  const double slope = q / (6.0 * inertia) * (1.0 - power(half, 3));
  const double deflection = q / (2.0 * inertia) * (0.5 * half * half - power(half, 3) / 3.0 + power(half, 4) / 12.0);
  EXPECT_NEAR(static_tip(1.0, thickness, young, 1e6 * young), -(deflection + slope * half), 5e-3 * beam);
}

TEST(StartingState, StaticEquilibriumWithoutAnyForceIsFound) {
  CaseRun run("[mesh]\nfile = \"" + block_mesh(0.0) +
              "\"\n[[material]]\ngroup = \"body\"\ndensity = 2.0\nyoung = 1000.0\npoisson = 0.3\n"
              "[[support]]\ngroup = \"left\"\ncomponents = [\"x\", \"y\"]\nvalue = 0.3\n[initial]\ndisplacement = "
              "\"static\"\n[mass]\ntype = \"consistent\"\n" +
              newmark);
  EXPECT_LT((run.state().displacement.array() - 0.3).abs().maxCoeff(), 1e-12);
}

TEST(StiffBody, EnergyAccountClosesThoughTheBodyMovesFar) {
  // A steel block in SI units falls five times its size: its strain energy is nearly zero, and must not be the rounding
  // of K times the fall.
  for (const char* scheme : {"scheme = \"midpoint\"\n", "scheme = \"klr-conserving\"\n",
                             "scheme = \"newmark\"\npreset = \"trapezoidal\"\n"}) {
    CaseRun run("[mesh]\nfile = \"" + block_mesh(10.0) +
                "\"\n[[material]]\ngroup = \"body\"\ndensity = 7850.0\nyoung = 2.1e11\npoisson = 0.3\n"
                "[load]\ngravity = [0.0, -9.81]\n[initial]\nvelocity = [\"1-0.001*y\", \"0.001*x\"]\n"
                "[mass]\ntype = \"consistent\"\n[time]\n" +
                std::string(scheme) + "step = 1e-3\nend = 1.0\n");
    double worst = 0.0, largest = 0.0;
    run.run([&] {
      const Energies now = run.simulation().account().energies(run.state());
      largest = std::max(largest, now.kinetic);
      worst = std::max(worst, std::abs(run.simulation().account().residual(now)));
    });
    EXPECT_LT(worst, 1e-11 * largest) << scheme;
  }
}

TEST(FreeFall, LeavesTheBodyUndeformedWithEveryMass) {
  for (const char* mass : {"consistent", "lumped", "equivalent", "equivalent-lumped"}) {
    CaseRun run(block_case(100.0, mass, newmark));
    double elastic = 0.0;
    run.run([&] { elastic = std::max(elastic, run.simulation().account().energies(run.state()).elastic); });
    const double fallen = 0.5 * 10.0 * 0.2 * 0.2;
    EXPECT_LT(elastic, 1e-12 * 4.0 * 10.0 * fallen) << mass;
    EXPECT_NEAR(run.state().displacement[1], -fallen, 1e-11) << mass;
  }
}

}  // namespace ricochet::test_support::starting_state_test
