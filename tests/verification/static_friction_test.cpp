#include <gtest/gtest.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>

#include "support/case_run.hpp"
#include "support/contact_problems.hpp"
#include "support/errors.hpp"

// Static starts of bodies that slide along their obstacle at t = 0.

namespace ricochet::test_support::static_friction_test {

constexpr double friction = 0.3;
constexpr double weight = 2.0 * 1.0 * 10.0;  // a block of 2 × 1 with density 1 and g = 10

/// A block [0, 2] × [0, 1] on the floor, under gravity.
std::string block_case(const std::string& mass, const std::string& belt_velocity, const std::string& velocity,
                       const std::string& more = "", const std::string& gravity = "[0.0, -10.0]") {
  const std::string mesh =
      mesh_geometry("block",
                    "Rectangle(1)={0,0,0,2,1}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1}; "
                    "Physical Curve(\"right\")={2}; Physical Curve(\"top\")={3};",
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
  run.state().forces.rows->add_force(run.state().forces.normal_reaction, run.state().forces.tangential_reaction, force);
  double sum = 0.0;
  for (Index i = component; i < force.size(); i += run.problem().dimension) sum += force[i];
  return sum;
}

/// F times the normal reactions at points where friction can act, which excludes a corner held by a support.
double largest_friction(const CaseRun& run) {
  const ContactBoundary& contact = run.problem().contact;
  double sum = 0.0;
  for (Index i = 0; i < contact.size(); ++i) {
    if (contact.rows->tangential_trace.row(i).nonZeros() > 0) sum += friction * run.state().forces.normal_reaction[i];
  }
  return sum;
}

TEST(StaticFriction, FreelySlidingBlockStaysWhereItIs) {
  for (const char* mass : {"equivalent", "consistent"}) {
    for (const char* velocity : {"[0.5, 0.0]", "[-1e-6, 0.0]"}) {
      CaseRun run(block_case(mass, "[0.0, 0.0]", velocity));
      // Compressed by its own weight, ρ g / 2E, only: not displaced by the size of the body.
      EXPECT_LT(run.state().displacement.lpNorm<Eigen::Infinity>(), 3e-3) << mass << velocity;
      // Massless contact nodes move to equilibrium with the new friction.
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
  expect_error({"no equilibrium", "friction does not hold points that slide at t = 0"},
               [&] { CaseRun run(block_case("equivalent", "[0.0, 0.0]", "[0.1, 0.0]", "", "[1.0, -10.0]")); });
}

/// A block on a floor in two or three dimensions, with gravity inclined by an angle to it.
struct InclinedBlock {
  int dimension;
  double angle, heading;  ///< of gravity: to the normal of the floor, and along the floor
  double friction;
  std::string mass, multipliers, mesh;

  [[nodiscard]] std::vector<double> down() const {
    const double along = std::sin(angle), across = -std::cos(angle);
    if (dimension == 2) return {along * (heading < 3.0 ? 1.0 : -1.0), across};
    return {along * std::cos(heading), along * std::sin(heading), across};
  }
  [[nodiscard]] std::string text() const {
    const bool flat = dimension == 2;
    const std::vector<double> g = down();
    return fmt::format(
        "[mesh]\nfile = \"{}\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 1e4\npoisson = 0.3\n"
        "[obstacle.floor]\ntype = \"plane\"\npoint = [{}]\nnormal = [{}]\n[[contact]]\ngroup = \"bottom\"\n"
        "obstacle = \"floor\"\nfriction = {:.17g}\nmultipliers = \"{}\"\nunstable_multipliers = \"allow\"\n"
        "[load]\ngravity = [{:.17g}]\n[initial]\ndisplacement = \"static\"\n[mass]\ntype = \"{}\"\n"
        "[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 0.001\nend = 0.01\n",
        mesh, flat ? "0, 0" : "0, 0, 0", flat ? "0, 1" : "0, 0, 1", friction, multipliers, fmt::join(g, ", "), mass);
  }
};

std::string inclined_mesh(int dimension) {
  return dimension == 2 ? mesh_geometry("block",
                                        "Rectangle(1)={0,0,0,3,1}; Physical Surface(\"body\")={1}; "
                                        "Physical Curve(\"bottom\")={1};",
                                        0.34, 1)
                        : mesh_geometry("brick",
                                        "Box(1)={0,0,0,3,3,1}; Physical Volume(\"body\")={1}; "
                                        "Physical Surface(\"bottom\")={5};",
                                        1.0, 1);
}

/// Components of the vector in parentheses after a word.
std::vector<double> vector_after(const std::string& text, const std::string& word) {
  std::vector<double> result;
  const std::size_t at = text.find(word + " (");
  if (at == std::string::npos) return result;
  const std::size_t begin = at + word.size() + 2;
  std::stringstream list(text.substr(begin, text.find(')', begin) - begin));
  for (std::string part; std::getline(list, part, ',');) result.push_back(std::stod(part));
  return result;
}

/// A block slides down any incline steeper than its friction allows, however slightly, and the error states the
/// direction. RICOCHET_RANDOM_CASES=10 tries ten times as many inclines.
TEST(StaticFriction, OfABlockThatSlidesIsRefusedWithItsDirection) {
  const char* const factor = std::getenv("RICOCHET_RANDOM_CASES");
  const unsigned count = factor != nullptr ? 16 * unsigned(std::atoi(factor)) : 16;
  const std::string flat = inclined_mesh(2), brick = inclined_mesh(3);
  for (unsigned seed = 0; seed < count; ++seed) {
    std::mt19937 random(seed);
    const auto unit = [&] { return 0.5 * (uniform(random) + 1.0); };
    const char* const masses[] = {"equivalent", "consistent", "lumped"};
    const char* const kinds[] = {"nodal", "p0", "p1", "dual"};
    InclinedBlock block{seed % 4 == 3 ? 3 : 2, 0.05 + 0.7 * unit(),         6.0 * unit(), 0.0, masses[random() % 3],
                        kinds[random() % 4],   seed % 4 == 3 ? brick : flat};
    const double nearness = std::pow(10.0, -5.0 * unit());
    block.friction = std::tan(block.angle) * (1.0 - nearness);
    SCOPED_TRACE(fmt::format("seed {}, nearness {}\n{}", seed, nearness, block.text()));
    const std::string message = expect_error({"there is no equilibrium"}, [&] { CaseRun run(block.text()); });
    const std::vector<double> direction = vector_after(message, "slides in the direction");
    const std::vector<double> force = vector_after(message, "a force of");
    ASSERT_EQ(direction.size(), std::size_t(block.dimension)) << message;
    ASSERT_EQ(force.size(), direction.size()) << message;
    const std::vector<double> down = block.down();
    const double volume = block.dimension == 2 ? 3.0 : 9.0;
    for (std::size_t k = 0; k < direction.size(); ++k) {
      const bool along = k + 1 < direction.size();
      // Up to the three printed digits.
      EXPECT_NEAR(direction[k], along ? down[k] / std::sin(block.angle) : 0.0, 6e-4) << message;
      const double lacking = along ? volume * nearness * down[k] : 0.0;
      EXPECT_NEAR(force[k], lacking, 6e-3 * volume * nearness) << message;
    }
    // Sufficient friction is not refused.
    if (seed % 4 != 0) continue;
    block.friction = std::tan(block.angle) * (1.0 + std::max(nearness, 0.01));
    EXPECT_NO_THROW(CaseRun run(block.text()));
    if (HasFailure()) return;
  }
}

/// The error also gives the direction of a falling body.
TEST(StaticFriction, ABodyThatFallsIsRefusedWithItsDirection) {
  const std::string message =
      expect_error({}, [&] { CaseRun run(block_case("consistent", "[0.0, 0.0]", "[0.0, 0.0]", "", "[0.0, 10.0]")); });
  EXPECT_EQ(vector_after(message, "moves in the direction"), (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(vector_after(message, "a force of"), (std::vector<double>{0.0, 20.0})) << message;
}

/// A block pulled at its upper edge by more than its weight can balance.
TEST(StaticFriction, ABodyThatTipsIsRefused) {
  for (const double pull : {0.99, 1.01}) {
    // Friction holds it; it tips about a corner if pull × height > weight × half its width.
    std::string text =
        block_case("consistent", "[0.0, 0.0]", "[0.0, 0.0]",
                   fmt::format("[[traction]]\ngroup = \"top\"\nvalue = [{}, 0.0]\n", pull * weight / 2.0));
    text.replace(text.find("friction = 0.3"), 14, "friction = 1.5");
    if (pull < 1.0) {
      EXPECT_NO_THROW(CaseRun run(text));
      continue;
    }
    expect_error({"there is no equilibrium"}, [&] { CaseRun run(text); });
  }
}

}  // namespace ricochet::test_support::static_friction_test
