#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/base/log.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"

/// @file Static starts of bodies inside an obstacle: a press fit is found, and the error reports any other overlap.
namespace ricochet::test_support::static_overlap_test {

/// A unit square of E = 100 whose lower side is `depth` inside the floor.
std::string square(const std::string& law, double depth, const std::string& held) {
  const std::string mesh = mesh_geometry(
      "static-overlap",
      "Rectangle(1) = {0, 0, 0, 1, 1};\nPhysical Surface(\"body\") = {1};\nPhysical Curve(\"bottom\") = {1};\n"
      "Physical Curve(\"top\") = {3};\n",
      0.25, 1);
  return fmt::format(
      "[mesh]\nfile = \"{}\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nlaw = \"{}\"\nyoung = 100.0\npoisson = "
      "0.3\n"
      "[obstacle.floor]\ntype = \"plane\"\npoint = [0, {}]\nnormal = [0, 1]\n[[contact]]\ngroup = \"bottom\"\n"
      "obstacle = \"floor\"\n[[support]]\ngroup = \"top\"\ncomponents = {}\n[initial]\ndisplacement = \"static\"\n"
      "[time]\nstep = 0.01\nend = 0.05\n",
      mesh, law, depth, held);
}

TEST(StaticOverlap, SmallOnesOfHeldBodiesArePressFits) {
  for (const std::string law : {"linear", "neo-hookean"}) {
    const CaseRun run(square(law, 0.05, "[\"x\", \"y\"]"));
    Vector gap;
    run.problem().gaps(run.state().displacement, 0.0, gap);
    EXPECT_LT(gap.cwiseAbs().maxCoeff(), 1e-12) << law;
    EXPECT_GT(run.state().forces.normal_reaction.minCoeff(), 0.0) << law;
  }
}

/// A held square of a law of finite strain is squeezed to any height, but not to none.
TEST(StaticOverlap, IsWhatTheErrorIsAbout) {
  struct Overlap {
    std::string law, held;
    double depth;
  };
  for (const Overlap& overlap : {Overlap{"linear", "[\"x\"]", 0.5}, Overlap{"neo-hookean", "[\"x\"]", 0.5},
                                 Overlap{"neo-hookean", "[\"x\", \"y\"]", 1.5}}) {
    const bool is_linear = overlap.law == "linear";
    const std::string message = expect_error(
        is_linear ? ErrorKind::invalid_input : ErrorKind::not_converged,
        {"initial.displacement = \"static\": without it 5 of 5 contact points are inside ",
         fmt::format("the deepest by {} at (", overlap.depth), ", 0) (contact.0)", "Move the obstacle or the body"},
        [&] { const CaseRun run(square(overlap.law, overlap.depth, overlap.held)); });
    EXPECT_EQ(has(message, "a slow ramp"), !is_linear) << message;
  }
}

TEST(StaticOverlap, IsSqueezedOutAtFiniteStrain) {
  const CaseRun run(square("neo-hookean", 0.5, "[\"x\", \"y\"]"));
  Vector gap;
  run.problem().gaps(run.state().displacement, 0.0, gap);
  EXPECT_LT(gap.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(run.state().forces.normal_reaction.minCoeff(), 0.0);
}

/// If nothing overlaps at the start, the reasons are those of the load path.
TEST(StaticOverlap, IsNotSaidWhereThereIsNone) {
  for (const std::string law : {"linear", "neo-hookean"}) {
    std::string text = square(law, -0.1, "[\"x\"]");
    text.insert(text.find("[initial]"), "[load]\ngravity = [0.0, 1.0]\n");
    const ErrorKind kind = law == "linear" ? ErrorKind::invalid_input : ErrorKind::not_converged;
    EXPECT_FALSE(has(expect_error(kind, {}, [&] { const CaseRun run(text); }), "without it")) << law;
  }
}

/// Gravity presses a square that may slide up and down at its sides onto a floor that is `depth` inside it: by more
/// than half of its height it has been lifted rather than squeezed.
TEST(StaticOverlap, ThatLiftsABodyByHalfOfItsHeightIsReported) {
  const auto warnings = [](double depth) {
    const log::Silence silence;
    std::string text = square("linear", depth, "[\"x\"]");
    text.insert(text.find("[initial]"), "[load]\ngravity = [0.0, -1.0]\n");
    const CaseRun run(text);
    return run.session().warnings();
  };
  EXPECT_TRUE(warnings(0.2).empty());
  const std::vector<std::string> lifted = warnings(0.7);
  ASSERT_EQ(lifted.size(), 1U);
  for (const std::string part :
       {"moves the body by 0.6", "more than half of its size in that direction, 1:", "on which side"})
    EXPECT_TRUE(has(lifted[0], part));
}

}  // namespace ricochet::test_support::static_overlap_test
