#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/mass/mass.hpp"
#include "support/case_run.hpp"
#include "support/energy_identity.hpp"
#include "support/errors.hpp"
#include "support/thrown_body.hpp"

// The discrete energy identities of each scheme: exact, for one step, on any mesh, frictionless. Energies and gaps are
// computed here from the state, not taken from the energy account. λ are nodal forces, g₀ and g₁ the gaps at the two
// ends.

namespace ricochet::test_support::energy_identities_test {

TEST(EnergyIdentity, MidpointChangesByMinusTwiceForceTimesFirstGap) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const char* mass : {"consistent", "lumped"}) {
      CaseRun run(thrown_case(body, mass, "scheme = \"midpoint\"\n"));
      expect_identity(run, body.name + ", " + mass,
                      [](const StepEnd& a, const StepEnd& b) { return -2.0 * b.normal.dot(a.gap); });
    }
  }
}

TEST(EnergyIdentity, TrapezoidalNewmarkWithAnyMass) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const char* mass : {"consistent", "lumped", "equivalent"}) {
      CaseRun run(thrown_case(body, mass, "scheme = \"newmark\"\npreset = \"trapezoidal\"\n"));
      expect_identity(run, body.name + ", " + mass, [](const StepEnd& a, const StepEnd& b) {
        return 0.5 * (a.normal.dot(b.gap) - b.normal.dot(a.gap));
      });
    }
  }
}

TEST(EnergyIdentity, NewmarkWithAnyParametersAndMass) {
  const double h = 0.01;
  for (const ThrownBody& body : thrown_bodies()) {
    for (const auto& [beta, gamma] : {std::pair{0.5, 0.5}, {0.3025, 0.6}, {0.25, 0.5}, {0.5, 1.0}}) {
      for (const char* mass : {"consistent", "equivalent"}) {
        CaseRun run(thrown_case(
            body, mass,
            "scheme = \"newmark\"\nbeta = " + std::to_string(beta) + "\ngamma = " + std::to_string(gamma) + "\n"));
        const SparseMatrix m = run.problem().mass.to_sparse();
        const SparseMatrix& k = run.problem().internal_force->tangent();
        expect_identity(run, body.name + ", " + mass + ", beta " + std::to_string(beta),
                        [&, beta = beta, gamma = gamma](const StepEnd& a, const StepEnd& b) {
                          const Vector du = b.displacement - a.displacement;
                          const Vector da = b.acceleration - a.acceleration;
                          const double algorithmic =
                              b.acceleration.dot(m * b.acceleration) - a.acceleration.dot(m * a.acceleration);
                          return (1.0 - gamma) * a.normal.dot(b.gap) - gamma * b.normal.dot(a.gap) -
                                 (gamma - 0.5) * du.dot(k * du) -
                                 0.5 * h * h * (beta - 0.5 * gamma) *
                                     (algorithmic + (2.0 * gamma - 1.0) * da.dot(m * da));
                        });
      }
    }
  }
}

TEST(EnergyIdentity, KlrConservesTheHalfStepEnergy) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const char* mass : {"consistent", "lumped"}) {
      CaseRun run(thrown_case(body, mass, "scheme = \"klr-conserving\"\n"));
      Vector displacement, velocity;
      double first = 0.0, worst = 0.0, touched = 0.0, penetration = 0.0;
      run.run([&] {
        run.scheme().energy_state(run.state(), displacement, velocity);
        const double energy = total_energy(run.problem(), displacement, velocity);
        if (run.state().step == 0) first = energy;
        worst = std::max(worst, std::abs(energy / first - 1.0));
        const StepEnd end(run);
        touched = std::max(touched, end.normal.maxCoeff());
        penetration = std::max(penetration, -end.gap.minCoeff());
      });
      EXPECT_LT(worst, 1e-11) << body.name << ", " << mass;
      EXPECT_GT(touched, 0.0) << body.name;
      EXPECT_GT(penetration, 0.0) << body.name << ": the scheme is known to let nodes in a little";
    }
  }
}

/// Lengths of a step below the critical one of the smallest cells.
const char* explicit_step(const ThrownBody& body) {
  return body.dimension == 3 ? "time.step=0.0025" : "time.step=0.005";
}

TEST(EnergyIdentity, SemiExplicitIsNewmarkWithBetaZero) {
  for (const ThrownBody& body : thrown_bodies()) {
    CaseRun run(thrown_case(body, "equivalent-lumped", "scheme = \"semi-explicit\"\n"), {explicit_step(body)});
    const double h = run.scheme().step();
    const SparseMatrix m = run.problem().mass.to_sparse();
    expect_identity(run, body.name, [&](const StepEnd& a, const StepEnd& b) {
      const double algorithmic = b.acceleration.dot(m * b.acceleration) - a.acceleration.dot(m * a.acceleration);
      return 0.5 * (a.normal.dot(b.gap) - b.normal.dot(a.gap)) + 0.125 * h * h * algorithmic;
    });
  }
}

TEST(EnergyIdentity, SemiExplicitAtHalfSteps) {
  // E^{n+½} = ½VᵀMV + ½(Uⁿ)ᵀKU^{n+1} − Lᵀ(Uⁿ+U^{n+1})/2 with V = (U^{n+1}−Uⁿ)/h changes by ½λⁿ·(g^{n+1}−g^{n−1}).
  for (const ThrownBody& body : thrown_bodies()) {
    CaseRun run(thrown_case(body, "equivalent-lumped", "scheme = \"semi-explicit\"\n"), {explicit_step(body)});
    const SemidiscreteProblem& problem = run.problem();
    const auto energy = [&](const StepEnd& a, const StepEnd& b) {
      const Vector v = (b.displacement - a.displacement) / run.scheme().step();
      Vector force;
      problem.internal_force->evaluate(b.displacement, force);
      return 0.5 * problem.mass.quadratic_form(v) + 0.5 * a.displacement.dot(force) -
             0.5 * problem.loads.constant().dot(a.displacement + b.displacement);
    };
    std::vector<StepEnd> last;
    double worst = 0.0, touched = 0.0;
    run.run([&] {
      last.emplace_back(run);
      if (last.size() < 3) return;
      const double change = energy(last[1], last[2]) - energy(last[0], last[1]);
      const double identity = 0.5 * last[1].normal.dot(last[2].gap - last[0].gap);
      worst = std::max(worst, std::abs(change - identity) / last[1].size_of_energy_terms);
      touched = std::max(touched, last[1].normal.maxCoeff());
      last.erase(last.begin());
    });
    EXPECT_LT(worst, 20.0 * std::numeric_limits<double>::epsilon()) << body.name;
    EXPECT_GT(touched, 0.0) << body.name;
  }
}

TEST(EnergyIdentity, ContactStabilizedLosesEnergyOnly) {
  // −r_N·g₀ of the forces at the end, and the energy taken by projecting the free flight, each of them a loss.
  for (const ThrownBody& body : thrown_bodies()) {
    for (const std::string& mass : masses_of("contact-stabilized")) {
      CaseRun run(thrown_case(body, mass, "scheme = \"contact-stabilized\"\n"));
      const double h = run.scheme().step();
      double created = 0.0, by_projection = 0.0, deepest = 0.0;
      expect_identity(run, body.name + ", " + mass, [&](const StepEnd& a, const StepEnd& b) {
        // U₁ − Û = (h/2)(V₁ − V₀), and Û − U₀ − hV₀ is the projection of the free flight.
        const Vector last = 0.5 * h * (b.velocity - a.velocity);
        const Vector shift = b.displacement - last - a.displacement - h * a.velocity;
        Vector momentum;
        run.problem().mass.multiply(last, momentum);
        const double projected = -2.0 / (h * h) * shift.dot(momentum), at_end = -b.normal.dot(a.gap);
        created = std::max({created, projected / b.size_of_energy_terms, at_end / b.size_of_energy_terms});
        by_projection = std::min(by_projection, projected);
        deepest = std::max(deepest, -b.gap.minCoeff());
        return at_end + projected;
      });
      EXPECT_LT(created, 20.0 * std::numeric_limits<double>::epsilon()) << body.name << ", " << mass;
      EXPECT_LT(by_projection, 0.0) << body.name << ": nothing was projected";
      EXPECT_LT(deepest, 1e-12) << body.name;
    }
  }
}

TEST(EnergyIdentity, SchemesRefuseTheMassesThatTheyDoNotTake) {
  const ThrownBody body = one_sided_block();
  for (const std::string& scheme : scheme_names()) {
    const std::vector<std::string> taken = masses_of(scheme);
    for (const std::string& mass : mass_names()) {
      if (std::ranges::find(taken, mass) != taken.end()) continue;
      SCOPED_TRACE(scheme + " takes " + mass);
      expect_error({"scheme \"" + scheme + "\""}, [&] { const CaseRun run(thrown_case(body, mass, time_of(scheme))); });
    }
  }
}

/// Every registered scheme has an identity in this file or in published_schemes_test.cpp.
TEST(EnergyIdentity, IsKnownOfEveryScheme) {
  EXPECT_EQ(scheme_names(), (std::vector<std::string>{"midpoint",
                                                      "klr-conserving",
                                                      "newmark",
                                                      "semi-explicit",
                                                      "contact-stabilized",
                                                      "reduced-kane",
                                                      "mean-reaction",
                                                      "reduced-midpoint",
                                                      "kane",
                                                      "generalized-alpha",
                                                      "hht-alpha",
                                                      "wbz-alpha",
                                                      "bathe",
                                                      "laursen-chawla",
                                                      "moreau-jean",
                                                      "paoli-schatzman",
                                                      "cd-lagrange",
                                                      "taylor-flanagan",
                                                      "laursen-love",
                                                      "penalty-midpoint",
                                                      "nitsche",
                                                      "nonsmooth-generalized-alpha"}));
}

TEST(EnergyIdentity, AccountClosesWithSupportsDampingAndLoadsThatVary) {
  const std::string block =
      "Rectangle(1)={0,0.01,0,2,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1}; "
      "Physical Curve(\"left\")={4}; Physical Curve(\"top\")={3};";
  const std::string mesh = mesh_geometry("block", block, 0.3, 1);
  std::vector<std::pair<std::string, std::string>> schemes;
  for (const std::string& name : scheme_names()) schemes.emplace_back(name, time_of(name));
  schemes.emplace_back("newmark", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n");
  for (const auto& [name, scheme] : schemes) {
    for (const std::string& mass : masses_of(name)) {
      CaseRun run(
          "[mesh]\nfile = \"" + mesh +
          "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 50.0\npoisson = 0.3\ndamping = { mass = " +
          std::string(takes_damping(name) ? "0.1" : "0.0") +
          ", "
          "stiffness = " +
          std::string(takes_stiffness_damping(name) ? "0.002" : "0.0") +
          " }\n"
          "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
          "[[contact]]\ngroup = \"contact\"\nobstacle = \"floor\"\n"
          "[[support]]\ngroup = \"left\"\ncomponents = [\"x\"]\nvalue = \"0.05*sin(3*t)\"\n"
          "[[traction]]\ngroup = \"top\"\nvalue = [\"0.3*x*cos(t)\", \"-p*min(t/0.2, 1)\"]\nparameters = { p = 1.0 }\n"
          "[load]\ngravity = [0.0, -1.0]\nbody_force = [\"0.1*t\", \"0.1*y\"]\n"
          "[mass]\ntype = \"" +
          mass + "\"\n[time]\n" + scheme + "step = 0.01\nend = 2.0\n");
      double worst = 0.0, largest = 0.0;
      run.run([&] {
        const Energies now = run.simulation().account().energies(run.state());
        largest = std::max({largest, std::abs(now.kinetic), std::abs(now.elastic), std::abs(now.total())});
        worst = std::max(worst, std::abs(run.simulation().account().residual(now)));
      });
      EXPECT_LT(worst, 1e-12 * largest) << scheme << mass;
      const Works& works = run.simulation().account().works();
      EXPECT_NE(works.load, 0.0);
      EXPECT_NE(works.support, 0.0);
      EXPECT_EQ(works.damping < 0.0, takes_damping(name)) << "damping takes energy away";
    }
  }
}

}  // namespace ricochet::test_support::energy_identities_test
