#include <gtest/gtest.h>

#include "ricochet/problem/distortion_force.hpp"
#include "support/box_mesh.hpp"
#include "support/case_run.hpp"
#include "support/two_bodies.hpp"

/// @file Bodies whose cells of degree 2 would be turned inside out at their nodes, where no quadrature point sees it.
namespace ricochet::test_support {
namespace {

/// A free square of nearly incompressible rubber, whose right-hand side is thrown towards its left-hand side.
std::string squeezed_square(double speed) {
  const Mesh mesh = make_box_mesh(box_of(CellShape::quadrilateral, {2, 2}));
  return "[mesh]\nfile = \"" + write_mesh("distorted.msh", mesh) +
         "\"\ndegree = 2\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nyoung = 1.0\npoisson = 0.49\n"
         "law = \"neo-hookean\"\n[initial]\nvelocity = [\"-" +
         std::to_string(speed) + "*x^3\", \"0.3*x*y\"]\n[time]\nstep = 0.02\nend = 2.0\n";
}

double volume(const CaseRun& run) {
  return run.problem().internal_force->distortion()->smallest_nodal_volume(run.state().displacement).volume_ratio;
}
double control_energy(const CaseRun& run) {
  return run.problem().internal_force->distortion()->distortion_energy(run.state().displacement);
}
double energy(const CaseRun& run) {
  return 0.5 * run.problem().mass.quadratic_form(run.state().velocity) +
         run.problem().internal_force->energy(run.state().displacement);
}

TEST(DistortedCells, AreKeptUprightAtTheirNodesWithoutCreatingEnergy) {
  CaseRun run(squeezed_square(1.5));
  const double at_start = energy(run);
  double smallest = 1.0, largest = 0.0;
  run.run([&] {
    smallest = std::min(smallest, volume(run));
    largest = std::max(largest, control_energy(run));
    EXPECT_NEAR(energy(run), at_start, 1e-12 * at_start);
  });
  EXPECT_GT(smallest, 0.0);
  EXPECT_LT(smallest, 0.2);
  EXPECT_GT(largest, 0.01 * at_start);
}

/// Whether a step includes the control depends on the state at its start and end alone.
TEST(DistortedCells, AreResumedWithTheSameBits) {
  for (const long saved : {20, 40, 60}) {
    CaseRun run(squeezed_square(1.5)), resumed(squeezed_square(1.5));
    while (run.steps() < saved) run.simulation().advance();
    Snapshot snapshot;
    run.simulation().save(snapshot);
    Simulation again(resumed.problem(), resumed.scheme(), snapshot);
    for (int k = 0; k < 20; ++k) {
      run.simulation().advance();
      again.advance();
    }
    EXPECT_EQ(run.state().displacement, again.state().displacement) << saved;
  }
}

TEST(DistortedCells, AreNoneAtSmallStrains) {
  CaseRun run(squeezed_square(0.1));
  run.run([&] { EXPECT_EQ(control_energy(run), 0.0); });
  EXPECT_GT(volume(run), 0.5);
}

}  // namespace
}  // namespace ricochet::test_support
