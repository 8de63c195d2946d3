#include <gtest/gtest.h>

#include "support/case_run.hpp"
#include "support/errors.hpp"

/// @file Loads that vary in time, on massless contact nodes, at finite strain.
namespace ricochet::test_support::finite_loads_test {

/// A block just above the floor, with strains of 10⁻⁷.
std::string case_of(const std::string& law, const std::string& loads, const std::string& time) {
  const std::string mesh = mesh_geometry("finite-loads",
                                         "Rectangle(1) = {0, 0, 0, 1, 0.6};\nPhysical Surface(\"all\") = {1};\n"
                                         "Physical Curve(\"boundary\") = {1, 2, 3, 4};\n",
                                         0.2, 1);
  return "[mesh]\nfile = \"" + mesh +
         "\"\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nyoung = 1.0\npoisson = 0.3\nlaw = \"" + law + "\"\n" +
         (law == "linear" ? "" : "dilatation = \"pointwise\"\n") +
         "[obstacle.floor]\ntype = \"plane\"\npoint = [0, -1e-8]\nnormal = [0, 1]\n"
         "[[contact]]\ngroup = \"boundary\"\nobstacle = \"floor\"\n" +
         loads + "[initial]\nvelocity = [0, -3e-8]\n[time]\n" + time + "end = 1.2\n";
}

/// Contact opens and closes while loads change: in the limit of small loads a step equals that of the linear law,
/// whatever the weight of the end's reactions. A load evaluated at another instant on contact nodes alone, or the work
/// of a straight path on a kinked one, is off by per cents, however small strains are.
TEST(FiniteLoads, AreThoseOfTheLinearLawInTheLimit) {
  const std::string traction =
      "[[traction]]\ngroup = \"boundary\"\nvalue = [\"4e-8*cos(7.3*t)\", \"-1.4e-7*(0.3+sin(7.2*t))\"]\n";
  const std::string pressure =
      "[[traction]]\ngroup = \"boundary\"\nvalue = [\"0\", \"-7.9e-8\"]\n"
      "[[pressure]]\ngroup = \"boundary\"\nvalue = \"8e-8*sin(7*t)\"\n";
  for (const std::string& loads : {traction, pressure}) {
    for (const std::string time :
         {"scheme = \"mean-reaction\"\n", "scheme = \"reduced-kane\"\nreaction_weight = \"end\"\n",
          "scheme = \"reduced-kane\"\nreaction_weight = \"adaptive\"\n"}) {
      for (const std::string step : {"step = 0.04\n", "step = 0.3\n"}) {
        CaseRun linear(case_of("linear", loads, time + step)),
            finite(case_of("saint-venant-kirchhoff", loads, time + step));
        double largest = 0.0;
        for (long i = 0; i < linear.steps(); ++i) {
          linear.simulation().advance();
          finite.simulation().advance();
          const double size = linear.state().velocity.norm();
          EXPECT_LT((finite.state().velocity - linear.state().velocity).norm(), 1e-5 * size)
              << loads << time << step << i;
          EXPECT_EQ(finite.simulation().cut_steps(), 0) << loads << time << step << i;
          largest = std::max(largest, linear.state().forces.normal_reaction.maxCoeff());
        }
        EXPECT_GT(largest, 1e-9) << loads << time << step;
      }
    }
  }
}

/// Neither a shorter step nor another factor gives the load a value.
TEST(FiniteLoads, WithoutAValueAreInvalidInput) {
  CaseRun run(case_of("neo-hookean", "[[traction]]\ngroup = \"boundary\"\nvalue = [\"0\", \"1e-8*sqrt(0.5-t)\"]\n",
                      "scheme = \"reduced-kane\"\nstep = 0.1\n"));
  expect_error({}, [&] { run.run([] {}); });
  EXPECT_EQ(run.state().step, 5);
}

}  // namespace ricochet::test_support::finite_loads_test
