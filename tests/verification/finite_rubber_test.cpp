#include <gtest/gtest.h>

#include <algorithm>

#include "support/case_run.hpp"
#include "support/motion_totals.hpp"

/// @file Steps whose operators are far from the tangent: rubber that is squeezed and cannot slide.
namespace ricochet::test_support::finite_rubber_test {

std::string grid(const std::string& sizes, const std::string& lines) {
  return "Rectangle(1) = {" + sizes + "};\n" + lines +
         "Transfinite Surface{1};\nRecombine Surface{1};\nPhysical Surface(\"body\") = {1};\n"
         "Physical Curve(\"bottom\") = {1};\nPhysical Curve(\"top\") = {3};\n";
}

/// A ring of rubber, 10 mm thick and 20 mm high, on the floor, struck by a block of steel at 3 m/s.
std::string bumper(const std::string& contact, const std::string& relaxation) {
  const std::string rubber = mesh_geometry(
      "bumper-rubber", grid("0.005, 0, 0, 0.01, 0.02", "Transfinite Curve{1, 3} = 6;\nTransfinite Curve{2, 4} = 11;\n"),
      1.0, 1);
  const std::string steel = mesh_geometry(
      "bumper-steel", grid("0, 0, 0, 0.02, 0.03", "Transfinite Curve{1, 3} = 4;\nTransfinite Curve{2, 4} = 3;\n"), 1.0,
      1);
  return "[mesh]\nplane = \"axisymmetric\"\n[part.bumper]\nfile = \"" + rubber + "\"\n[part.block]\nfile = \"" + steel +
         "\"\nmove = [0.0, 0.0201]\nvelocity = [0.0, -3.0]\n"
         "[[material]]\ngroup = \"bumper.body\"\ndensity = 1100.0\nlaw = \"neo-hookean\"\nyoung = 3.0e6\npoisson = "
         "0.495\n" +
         relaxation +
         "[[material]]\ngroup = \"block.body\"\ndensity = 7800.0\nlaw = \"neo-hookean\"\nyoung = 2.1e11\npoisson = "
         "0.3\n"
         "[[support]]\ngroup = \"bumper.bottom\"\ncomponents = [\"x\", \"y\"]\n"
         "[[contact]]\ngroup = \"bumper.top\"\nagainst = \"block.bottom\"\n" +
         contact + "[time]\nscheme = \"reduced-kane\"\nstep = 1e-4\nend = 4e-3\n";
}

/// Sheared cells rotate the direction in which they are a hundred times stiffer, and rotating contact forces are as
/// large as the stiffness of their nodes: corrections with the operator of the undeformed body, and with that at the
/// current positions, grow, however short a step is.
TEST(FiniteRubber, IsSqueezedByASixthUnderFriction) {
  const std::string relaxing = "relaxation = { modulus = [0.8, 0.4], time = [1.0e-3, 1.0e-2] }\n";
  for (const std::string contact : {"", "friction = 0.4\n"}) {
    for (const std::string& relaxation : {std::string(), relaxing}) {
      CaseRun run(bumper(contact, relaxation));
      const double start = energy_of(run);
      double before = start, squeezed = 0.0;
      run.run(
          [&] {
            const double energy = energy_of(run);
            EXPECT_LT(energy, before + 1e-11 * start) << contact << relaxation << run.state().step;
            before = energy;
            const Energies energies = run.simulation().account().energies(run.state());
            EXPECT_NEAR(run.simulation().account().residual(energies), 0.0, 1e-10 * start);
            squeezed = std::max(squeezed, -run.state().displacement.minCoeff());
          },
          false);
      EXPECT_GT(squeezed, 0.0032) << contact << relaxation;
    }
  }
}

/// A block whose corner strikes the floor in steps that are long for its cells: at first contact these are in
/// equilibrium during a step, and the positions undo any stress added in its middle.
TEST(FiniteRubber, KeepsItsEnergyWhereNoStressBalancesAStep) {
  const std::string block = mesh_geometry(
      "corner-block",
      "Rectangle(1) = {0, 0, 0, 1, 1};\nTransfinite Curve{1, 2, 3, 4} = 6;\nTransfinite Surface{1};\n"
      "Recombine Surface{1};\nPhysical Surface(\"body\") = {1};\nPhysical Curve(\"boundary\") = {1, 2, 3, 4};\n",
      1.0, 1);
  for (const std::string scheme : {"reduced-kane", "mean-reaction"}) {
    CaseRun run(
        "[mesh]\nfile = \"" + block +
        "\"\nturn = { angle = 18.93, about = [0.5, 0.5] }\n[[material]]\ngroup = \"body\"\ndensity = 1000.0\nlaw = "
        "\"saint-venant-kirchhoff\"\nyoung = 1000.0\npoisson = 0.499\n[obstacle.floor]\ntype = \"plane\"\npoint = "
        "[0.0, -0.2081]\nnormal = [0.0, 1.0]\n[[contact]]\ngroup = \"boundary\"\nobstacle = \"floor\"\n[[motion]]\n"
        "group = \"body\"\nspin = 0.17\n[initial]\nvelocity = [0.0, -0.6284]\n[time]\nscheme = \"" +
        scheme + "\"\nstep = 0.0125\nend = 0.1625\n");
    const double start = energy_of(run);
    double before = start, force = 0.0;
    const Momenta first(run);
    run.run(
        [&] {
          const double energy = energy_of(run);
          EXPECT_LT(energy, before + 1e-12 * start) << scheme << run.state().step;
          before = energy;
          EXPECT_NEAR(Momenta(run).linear[0], first.linear[0], 1e-12 * first.linear.norm());
          force = std::max(force, run.state().forces.normal_reaction.sum());
        },
        false);
    EXPECT_LT(std::abs(run.simulation().account().works().integration_error), 1e-11 * start) << scheme;
    EXPECT_GT(force, 1.0);
  }
}

}  // namespace ricochet::test_support::finite_rubber_test
