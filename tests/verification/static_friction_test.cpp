#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"
#include "support/case_run.hpp"

// Static starts of bodies that slide along their obstacle at t = 0.

namespace ricochet {
namespace {

using test_support::CaseRun;

constexpr double friction = 0.3;
constexpr double weight = 2.0 * 1.0 * 10.0;  // a block of 2 × 1 with density 1 and g = 10

/// A block [0, 2] × [0, 1] on the floor, under gravity.
std::string block_case(const std::string& mass, const std::string& belt_velocity, const std::string& velocity,
                       const std::string& more = "", const std::string& gravity = "[0.0, -10.0]") {
  const std::string mesh = test_support::mesh_geometry(
      "block",
      "Rectangle(1)={0,0,0,2,1}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1}; "
      "Physical Curve(\"right\")={2};",
      0.25, 1);
  return "[mesh]\nfile = \"" + mesh +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 1e4\npoisson = 0.3\n"
         "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\nvelocity = " +
         belt_velocity + "\n[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\nfriction = 0.3\n" + more +
         "[load]\ngravity = " + gravity + "\n[initial]\ndisplacement = \"static\"\nvelocity = " + velocity +
         "\n[mass]\ntype = \"" + mass +
         "\"\n[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 0.001\nend = 0.01\n";
}

double contact_force(const CaseRun& run, int component) {
  Vector force = Vector::Zero(run.problem().dof_count());
  run.problem().add_contact_force(run.state().forces.normal_reaction, run.state().forces.tangential_reaction, force);
  double sum = 0.0;
  for (Index i = component; i < force.size(); i += run.problem().dimension) sum += force[i];
  return sum;
}

/// F times the normal reactions, at points where friction can act: not at a corner that a support holds.
double largest_friction(const CaseRun& run) {
  const ContactBoundary& contact = run.problem().contact;
  double sum = 0.0;
  for (Index i = 0; i < contact.size(); ++i) {
    if (contact.tangential_trace.row(i).nonZeros() > 0) sum += friction * run.state().forces.normal_reaction[i];
  }
  return sum;
}

TEST(StaticFriction, FreelySlidingBlockStaysWhereItIs) {
  for (const char* mass : {"equivalent", "consistent"}) {
    for (const char* velocity : {"[0.5, 0.0]", "[-1e-6, 0.0]"}) {
      CaseRun run(block_case(mass, "[0.0, 0.0]", velocity));
      // Compressed by its own weight, ρ g / 2E, and no more: not carried along by the size of the body.
      EXPECT_LT(run.state().displacement.lpNorm<Eigen::Infinity>(), 3e-3) << mass << velocity;
      // Massless contact nodes take their equilibrium with the friction that sets in.
      EXPECT_NEAR(contact_force(run, 1), weight, (mass[0] == 'e' ? 0.02 : 1e-9) * weight) << mass << velocity;
      if (velocity[1] == '-') continue;  // it stops within a step
      EXPECT_NEAR(contact_force(run, 0), -largest_friction(run), 1e-9 * weight) << mass;
    }
  }
}

TEST(StaticFriction, BlockHeldAgainstABeltIsInEquilibriumWithItsFriction) {
  for (const char* mass : {"equivalent", "consistent"}) {
    CaseRun run(block_case(mass, "[0.7, 0.0]", "[0.0, 0.0]",
                           "[[support]]\ngroup = \"right\"\ncomponents = [\"x\"]\nvalue = 0\n"));
    double largest = 0.0;
    run.run([&] {
      EXPECT_NEAR(run.state().forces.support_reaction.sum(), -largest_friction(run), 1e-8 * weight) << mass;
      EXPECT_NEAR(contact_force(run, 0), largest_friction(run), 1e-8 * weight) << mass;
      EXPECT_NEAR(contact_force(run, 1), weight, 1e-8 * weight) << mass;
      EXPECT_GT(largest_friction(run), 0.9 * friction * weight) << mass;
      largest = std::max(largest, run.state().velocity.lpNorm<Eigen::Infinity>());
    });
    EXPECT_LT(largest, 1e-8) << mass << ": it moves";
  }
}

TEST(StaticFriction, BlockThatSlidesDownASlopeIsRefused) {
  try {
    CaseRun run(block_case("equivalent", "[0.0, 0.0]", "[0.1, 0.0]", "", "[1.0, -10.0]"));
    FAIL() << "not refused";
  } catch (const Error& problem) {
    const std::string text = problem.what();
    EXPECT_NE(text.find("no equilibrium"), std::string::npos) << text;
    EXPECT_NE(text.find("friction does not hold points that slide at t = 0"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace ricochet
