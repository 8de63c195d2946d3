#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "ricochet/base/error.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/scheme/critical_step.hpp"
#include "ricochet/simulation/momentum_account.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file The scheme semi-explicit for bodies that turn and stretch: what it keeps, what it converges to, and its
/// critical step, which changes with the deformation.
namespace ricochet {
namespace {

using test_support::CaseRun;
using test_support::mesh_geometry;

std::string block(int dimension) {
  return dimension == 2 ? mesh_geometry("finite-block-2d",
                                        "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                        "Physical Curve(\"bottom\") = {1};\n",
                                        0.125, 1)
                        : mesh_geometry("finite-block-3d",
                                        "Box(1) = {0, 0, 0, 1, 0.5, 0.6};\nPhysical Volume(\"body\") = {1};\n"
                                        "Physical Surface(\"bottom\") = {3};\n",
                                        0.15, 1);
}

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
  return "[mesh]\nfile = \"" + block(flight.dimension) +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = " +
         fmt::format("{}", flight.poisson) + "\nlaw = \"" + flight.law +
         "\"\n[obstacle.floor]\ntype = \"plane\"\npoint = " +
         fmt::format("[0, {:.17g}{}]\nnormal = [0, 1{}]\n", -flight.height, plane ? "" : ", 0", plane ? "" : ", 0") +
         "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" + flight.more +
         "[initial]\ndisplacement = " + displacement + "\nvelocity = " + velocity +
         "\n[mass]\ntype = \"equivalent-lumped\"\n[time]\nscheme = \"" + flight.scheme +
         fmt::format("\"\nstep = {:.17g}\nend = {:.17g}\n", flight.step, flight.steps * flight.step);
}

std::string stretched(int dimension) {
  return dimension == 2 ? "[\"0.02*sin(5*x)\", \"0.02*sin(5*y)\"]"
                        : "[\"0.02*sin(5*x)\", \"0.02*sin(5*y)\", \"0.02*sin(4*z+x)\"]";
}
std::string spinning(int dimension) {
  return dimension == 2 ? "[\"0.3-2*(y-0.25)\", \"2*(x-0.5)\"]"
                        : "[\"0.3-2*(y-0.25)+(z-0.3)\", \"2*(x-0.5)-0.5*(z-0.3)\", \"0.5*(y-0.25)-(x-0.5)\"]";
}
std::string falling(int dimension) {
  return dimension == 2 ? "[\"0.3-2*(y-0.25)\", \"-0.5+2*(x-0.5)\"]"
                        : "[\"0.3-2*(y-0.25)\", \"-0.5+2*(x-0.5)\", \"0.2\"]";
}

/// About the origin and current positions, from the mass and the state alone.
struct Momenta {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  explicit Momenta(const CaseRun& run) {
    const SemidiscreteProblem& problem = run.problem();
    const Index d = problem.dimension;
    Vector momentum;
    problem.mass.multiply(run.state().velocity, momentum);
    for (Index node = 0; node < problem.nodes.cols(); ++node) {
      Eigen::Vector3d place = Eigen::Vector3d::Zero(), own = Eigen::Vector3d::Zero();
      place.head(d) = problem.nodes.col(node) + run.state().displacement.segment(node * d, d);
      own.head(d) = momentum.segment(node * d, d);
      linear += own;
      angular += place.cross(own);
    }
  }
};

double energy_of(const CaseRun& run) {
  return 0.5 * run.problem().mass.form(run.state().velocity) +
         run.problem().internal_force->energy(run.state().displacement) -
         run.problem().loads.constant().dot(run.state().displacement);
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

/// The energy goes up and down by O(h²), and does not drift over 10⁴ steps; the account closes with what the internal
/// forces miss.
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
    // Of a vibration (h²/8) AᵀMA is at most (h/h_c)² of the elastic energy.
    EXPECT_LT(of_first, std::pow(step / run.scheme().critical_step(), 2) * start);
    if (before > 0.0) {
      EXPECT_NEAR(before / of_first, 4.0, 1.0);
    }
    before = of_first;
  }
}

TEST(FiniteExplicit, IsOfSecondOrderInFlight) {
  const auto end_of = [&](double step) {
    CaseRun run(case_of({.step = step}, "[\"0.02*(x-0.5)\", \"-0.01*(y-0.25)\"]", "[\"-2*(y-0.25)\", \"2*(x-0.5)\"]"));
    while (run.state().time < 0.016 * (1.0 - 1e-9)) run.session().step();
    return run.state().displacement;
  };
  const Vector coarse = end_of(4e-4), middle = end_of(2e-4), fine = end_of(1e-4);
  const double rate = (coarse - middle).norm() / (middle - fine).norm();
  EXPECT_GT(rate, 3.5);
  EXPECT_LT(rate, 4.5);
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
        CaseRun linear = run_law("linear"), finite = run_law(law);
        double force = 0.0, difference = 0.0;
        while (linear.session().step() && finite.session().step()) {
          force = std::max(force, linear.state().forces.normal_reaction.sum());
          difference = std::max(difference, std::abs(linear.state().forces.normal_reaction.sum() -
                                                     finite.state().forces.normal_reaction.sum()));
        }
        EXPECT_GT(force, 0.0);
        EXPECT_LT(difference, 1e-6 * force) << law;
        const double size = linear.state().displacement.lpNorm<Eigen::Infinity>();
        EXPECT_LT((linear.state().displacement - finite.state().displacement).lpNorm<Eigen::Infinity>(), 1e-6 * size)
            << law;
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
            EXPECT_GT(run.state().newton_rounds, 0);
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

/// With gravity, friction and damping the impulses are those of all forces.
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

/// With fine steps, the motion of reduced-kane with the same mass: differences are of second order without friction,
/// and of first order with friction, where the reactions of the end act there.
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

/// 2/√λ with the largest eigenvalue λ of M⁻¹K on the dofs with mass, of the tangent at this displacement.
double dense_critical_step(const SemidiscreteProblem& problem, const Vector& displacement) {
  std::vector<Index> inside;
  for (Index dof = 0; dof < problem.dof_count(); ++dof) {
    if (problem.is_massless[static_cast<std::size_t>(dof)] == 0 && !problem.supports.contains(dof))
      inside.push_back(dof);
  }
  const Matrix stiffness = problem.internal_force->tangent(displacement);
  const Vector scale = Vector(problem.mass.diagonal())(inside).cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * stiffness(inside, inside) * scale.asDiagonal();
  return 2.0 /
         std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

/// A block that a press squeezes from above: an obstacle that comes down, `speed` along y, on a block held below.
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

TEST(FiniteExplicit, FollowsTheCriticalStepOfASqueezedBlock) {
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

/// Near to the limit every check matters: what has been found is within some per cent of the truth, in time.
TEST(FiniteExplicit, AStepThatBecomesTooLongEndsTheRunBeforeItBlowsUp) {
  const double rest = critical_of_rest(press(1.0, 1e-4, 1e-3));
  for (const double part : {0.7, 0.85, 0.95}) {
    CaseRun run(press(1.0, part * rest, 0.4));
    double exact = 0.0;
    std::string message;
    double most = 0.0;
    try {
      while (run.session().step()) {
        exact = dense_critical_step(run.problem(), run.state().displacement);
        const Energies energies = run.simulation().account().energies(run.state());
        most = std::max(most, std::abs(energies.algorithmic) / (energies.kinetic + energies.elastic));
      }
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::not_converged);
      message = error.what();
    }
    std::printf("step %.2f of the critical one at rest: ended at %.3f of the exact one. %s\n", part,
                part * rest / exact, message.c_str());
    EXPECT_NE(message.find("the critical step of \"semi-explicit\" is"), std::string::npos) << message;
    EXPECT_NE(message.find("set time.step = "), std::string::npos) << message;
    EXPECT_EQ(message.find("finer mesh"), std::string::npos) << message;
    EXPECT_NEAR(part * rest / exact, 1.0, 0.06);
    EXPECT_LT(most, 0.5) << "nothing has blown up";
    bool warned = false;
    for (const std::string& warning : run.session().warnings())
      warned = warned || warning.find("are deformed so far that the critical step is") != std::string::npos;
    EXPECT_EQ(warned, part < 0.9);
  }
}

/// Blocks that strike the floor with a corner, at up to a half of the wave speed: no step is taken that is longer than
/// the critical one of its start, but for the few per cent that are not found.
TEST(FiniteExplicit, NoStepOfAHardImpactIsBeyondTheCriticalOne) {
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
          EXPECT_NE(std::string(error.what()).find("critical step"), std::string::npos) << error.what();
          ++ended;
        }
      }
    }
  }
  EXPECT_GT(ended, 0);
  EXPECT_LT(ended, 12);
}

/// Cells that a step turns inside out are named, with the critical step and what to do.
TEST(FiniteExplicit, InvertedCellsAreNamed) {
  const double rest = critical_of_rest(press(1.0, 1e-4, 1e-3));
  CaseRun run(press(25.0, 0.3 * rest, 0.1));
  try {
    while (run.session().step()) continue;
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.kind(), ErrorKind::not_converged);
    std::printf("%s\n", message.c_str());
    EXPECT_NE(message.find("step "), std::string::npos) << message;
    EXPECT_NE(message.find("cell "), std::string::npos) << message;
    EXPECT_NE(message.find("critical step"), std::string::npos) << message;
    EXPECT_NE(message.find("time.step"), std::string::npos) << message;
  }
}

TEST(FiniteExplicit, RefusesAStartBeyondTheCriticalStep) {
  const std::string squeezed = "[initial]\ndisplacement = [\"0\", \"-0.45*y\"]\n";
  const double rest = critical_of_rest(press(1.0, 1e-4, 1e-3));
  std::string text = press(0.0, 0.95 * rest, 0.1, squeezed);
  text.replace(text.find("components = [\"x\", \"y\"]"), 23, "components = [\"y\"]     ");
  try {
    CaseRun run(text);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
    EXPECT_NE(std::string(error.what()).find("times the critical step"), std::string::npos) << error.what();
  }
}

void expect_same(const Snapshot& expected, const Snapshot& found) {
  ASSERT_EQ(expected.values().size(), found.values().size());
  for (const auto& [name, value] : expected.values()) {
    ASSERT_TRUE(found.has(name)) << name;
    const Snapshot::Value& other = found.values().at(name);
    ASSERT_EQ(value.index(), other.index()) << name;
    if (const auto* reals = std::get_if<Vector>(&value)) {
      const auto& others = std::get<Vector>(other);
      ASSERT_EQ(reals->size(), others.size()) << name;
      EXPECT_TRUE(reals->size() == 0 || std::memcmp(reals->data(), others.data(),
                                                    sizeof(double) * static_cast<std::size_t>(reals->size())) == 0)
          << name;
    } else {
      EXPECT_TRUE(value == other) << name;
    }
  }
}

TEST(FiniteExplicit, ResumesToTheSameBits) {
  const double rest = critical_of_rest(press(1.0, 1e-4, 1e-3));
  const std::string bounce =
      case_of({.height = 0.02, .steps = 300.0, .more = "friction = 0.3\n"}, "[\"0.05*sin(5*x)\", \"0.05*sin(5*y)\"]",
              "[\"0.3-6*(y-0.25)\", \"-2+6*(x-0.5)\"]");
  for (const std::string& text : {bounce, press(1.0, 0.4 * rest, 0.25, "[load]\ngravity = [1.0, 0.0]\n")}) {
    CaseRun run(text);
    std::map<long, Snapshot> snapshots;
    run.run([&] {
      const long step = run.state().step;
      if (step % 37 == 0) run.simulation().save(snapshots[step]);
    });
    Snapshot end;
    run.simulation().save(end);
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

}  // namespace
}  // namespace ricochet
