#include <gtest/gtest.h>

#include <algorithm>

#include "support/case_run.hpp"
#include "support/two_bodies.hpp"

/// @file Work of iterations at finite strain with bodies that slide far.
namespace ricochet::test_support {
namespace {

/// A small cube that lands on a larger one, and slides there.
CaseRun landing(int dimension, double friction) {
  const bool plane = dimension == 2;
  Vector place = Vector::Constant(dimension, 0.3);
  place[dimension - 1] = 1.004;
  const CellShape shape = plane ? CellShape::quadrilateral : CellShape::hexahedron;
  const Mesh mesh = make_stack({.lower_shape = shape,
                                .upper_shape = shape,
                                .lower_counts = plane ? std::vector{5, 2} : std::vector{4, 4, 2},
                                .upper_counts = plane ? std::vector{3, 2} : std::vector{2, 2, 2},
                                .upper_map = affine_map(0.4 * Matrix::Identity(dimension, dimension), place)});
  const std::string last = plane ? "y" : "z", fall = "\"" + last + " > 1.002 ? -1 : 0\"";
  return CaseRun("[mesh]\nfile = \"" + write_mesh("landing-" + last + ".msh", mesh) +
                 "\"\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nyoung = 1000.0\npoisson = 0.3\n"
                 "law = \"neo-hookean\"\n[[contact]]\ngroup = \"upper." +
                 last + "0\"\nagainst = \"lower." + last +
                 "1\"\nmultipliers_on = \"group\"\nsliding = \"large\"\nfriction = " + std::to_string(friction) +
                 "\n[initial]\nvelocity = [\"" + last + " > 1.002 ? 2 : 0\", " + (plane ? "" : "\"0\", ") + fall +
                 "]\n[mass]\ntype = \"equivalent\"\n[time]\nstep = 2e-3\nend = 0.04\n");
}

/// An iteration needs the gaps at its end, the rows in the middle of the step, and the couples at the middle of the
/// equations: three projections of the surfaces onto each other. A step needs its gaps at the start, and the account of
/// energy those at the end. (Points that face nothing at the start of a step need a fourth one; here all face the
/// body.)
TEST(SlidingCost, AnIterationProjectsTheSurfacesThreeTimes) {
  for (const int dimension : {2, 3}) {
    for (const double friction : {0.0, 0.3}) {
      CaseRun run = landing(dimension, friction);
      const ContactGeometry& geometry = *run.problem().contact.geometry;
      const long before = geometry.projection_count();
      long iterations = 0, steps = 0;
      double largest = 0.0;
      run.run(
          [&] {
            iterations += run.state().newton_iterations;
            ++steps;
            largest = std::max(largest, run.state().forces.normal_reaction.maxCoeff());
          },
          false);
      EXPECT_GT(largest, 0.0);
      EXPECT_GT(iterations, 4 * steps);
      EXPECT_LE(geometry.projection_count() - before, 3 * iterations + 2 * steps) << dimension << "D, F " << friction;
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
