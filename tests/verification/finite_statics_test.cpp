#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/fem/stress.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"

/// @file Static equilibria at finite strain, compared with closed forms.
namespace ricochet::test_support::finite_statics_test {

std::string cube() {
  return mesh_geometry(
      "finite-cube",
      "Box(1) = {0, 0, 0, 1, 1, 1};\nPhysical Volume(\"body\") = {1};\nPhysical Surface(\"x0\") = "
      "{1};\nPhysical Surface(\"x1\") = {2};\nPhysical Surface(\"y0\") = {3};\nPhysical Surface(\"y1\") = "
      "{4};\nPhysical Surface(\"z0\") = {5};\nPhysical Surface(\"z1\") = {6};\n",
      0.5, 1);
}

std::string square() {
  return mesh_geometry(
      "finite-square",
      "Rectangle(1) = {0, 0, 0, 1, 1};\nPhysical Surface(\"body\") = {1};\nPhysical Curve(\"y0\") = "
      "{1};\nPhysical Curve(\"x1\") = {2};\nPhysical Curve(\"y1\") = {3};\nPhysical Curve(\"x0\") = {4};\n",
      0.5, 1);
}

std::string body(const std::string& mesh, const std::string& law, const std::string& supports,
                 const std::string& more = "") {
  return "[mesh]\nfile = \"" + mesh + "\"\n" + more + "[[material]]\ngroup = \"body\"\ndensity = 1.0\n" + law +
         supports +
         "[initial]\ndisplacement = \"static\"\n[mass]\ntype = \"consistent\"\n[time]\nscheme = "
         "\"newmark\"\npreset = \"trapezoidal\"\nstep = 0.01\nend = 0.01\n";
}

std::string support(const std::string& group, const std::string& component, double value) {
  return fmt::format("[[support]]\ngroup = \"{}\"\ncomponents = [\"{}\"]\nvalue = \"{:.17g}\"\n", group, component,
                     value);
}

std::vector<double> stress_of(const CaseRun& run) {
  std::vector<double> stress, energy;
  CellStress(run.model().body).evaluate(run.state().displacement, stress, energy);
  return stress;
}

constexpr double lambda = 1.3, mu = 0.8;
const std::string neo_hookean = "law = \"neo-hookean\"\nlambda = 1.3\nmu = 0.8\n";

/// Principal stress σ_i = [μ(λ_i² − 1) + ½λ(J² − 1)]/J of W = (μ/2)(I₁ − 3 − 2 ln J) + (λ/4)(J² − 1 − 2 ln J).
double principal_stress(double stretch, double volume) {
  return (mu * (stretch * stretch - 1.0) + 0.5 * lambda * (volume * volume - 1.0)) / volume;
}

/// Lateral stretch of a bar without lateral stress, by bisection.
double free_stretch(double given, int free) {
  double low = 0.1, high = 3.0;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    const double volume = free == 2 ? given * middle * middle : given * given * middle;
    (principal_stress(middle, volume) > 0.0 ? high : low) = middle;
  }
  return low;
}

TEST(FiniteStatics, UniaxialStretch) {
  for (const double stretch : {2.0, 0.4}) {
    CaseRun run(body(cube(), neo_hookean,
                     support("x0", "x", 0.0) + support("y0", "y", 0.0) + support("z0", "z", 0.0) +
                         support("x1", "x", stretch - 1.0)));
    const double lateral = free_stretch(stretch, 2);
    const double wanted = principal_stress(stretch, stretch * lateral * lateral);
    const std::vector<double> stress = stress_of(run);
    for (std::size_t cell = 0; cell < stress.size() / 6; ++cell) {
      EXPECT_NEAR(stress[6 * cell], wanted, 1e-9);
      for (const std::size_t other : {1U, 2U, 3U, 4U, 5U}) EXPECT_NEAR(stress[6 * cell + other], 0.0, 1e-9);
    }
  }
}

TEST(FiniteStatics, BiaxialStretch) {
  CaseRun run(body(cube(), neo_hookean,
                   support("x0", "x", 0.0) + support("y0", "y", 0.0) + support("z0", "z", 0.0) +
                       support("x1", "x", 0.7) + support("y1", "y", 0.7)));
  const double thickness = free_stretch(1.7, 1);
  const double wanted = principal_stress(1.7, 1.7 * 1.7 * thickness);
  const std::vector<double> stress = stress_of(run);
  for (std::size_t cell = 0; cell < stress.size() / 6; ++cell) {
    EXPECT_NEAR(stress[6 * cell], wanted, 1e-9);
    EXPECT_NEAR(stress[6 * cell + 3], wanted, 1e-9);
    EXPECT_NEAR(stress[6 * cell + 5], 0.0, 1e-9);
  }
}

/// Plane stress in a plane mesh gives the stretch of a sheet.
TEST(FiniteStatics, PlaneStressIsTheStretchOfASheet) {
  CaseRun run(
      body(square(), neo_hookean,
           support("x0", "x", 0.0) + support("y0", "y", 0.0) + support("x1", "x", 0.7) + support("y1", "y", 0.7),
           "plane = \"stress\"\n"));
  const double thickness = free_stretch(1.7, 1);
  const double wanted = principal_stress(1.7, 1.7 * 1.7 * thickness);
  const std::vector<double> stress = stress_of(run);
  for (std::size_t cell = 0; cell < stress.size() / 6; ++cell) {
    EXPECT_NEAR(stress[6 * cell], wanted, 1e-9);
    EXPECT_NEAR(stress[6 * cell + 5], 0.0, 1e-9);
  }
}

/// Sheared between rigid plates the stress is not uniform, and the block is slightly softer than in simple shear, whose
/// shear stress is μγ; the forces on the plates are in equilibrium.
TEST(FiniteStatics, ShearBetweenRigidPlates) {
  const std::string supports = "[[support]]\ngroup = \"y0\"\ncomponents = [\"x\", \"y\", \"z\"]\n" +
                               support("y1", "x", 0.8) + "[[support]]\ngroup = \"y1\"\ncomponents = [\"y\", \"z\"]\n";
  CaseRun run(body(cube(), neo_hookean, supports));
  double top = 0.0, bottom = 0.0;
  const Vector& reaction = run.state().forces.support_reaction;
  for (Index i = 0; i < reaction.size(); ++i) {
    const Index dof = run.problem().supports.dofs()[std::size_t(i)];
    if (dof % 3 != 0) continue;
    (run.problem().nodes(1, dof / 3) > 0.5 ? top : bottom) += reaction[i];
  }
  EXPECT_NEAR(top, -bottom, 1e-10);
  EXPECT_GT(top, 0.5 * mu * 0.8);
  EXPECT_LT(top, 1.0 * mu * 0.8);
}

/// The elastica: a cantilever of bending stiffness EI under a dead force across its undeformed axis,
/// EI θ″ = −P cos θ, θ(0) = 0, θ′(L) = 0; the tip by shooting with the method of Runge and Kutta.
struct Tip {
  double x = 0.0, y = 0.0;
};
Tip elastica(double load) {
  constexpr int steps = 4000;
  const auto shoot = [&](double curvature, Tip& tip) {
    double theta = 0.0, rate = curvature;
    tip = {};
    const double h = 1.0 / steps;
    for (int k = 0; k < steps; ++k) {
      const auto slope = [&](double angle) { return -load * std::cos(angle); };
      const double k1 = rate, l1 = slope(theta), k2 = rate + 0.5 * h * l1, l2 = slope(theta + 0.5 * h * k1);
      const double k3 = rate + 0.5 * h * l2, l3 = slope(theta + 0.5 * h * k2), k4 = rate + h * l3,
                   l4 = slope(theta + h * k3);
      const double middle = theta + h / 8.0 * (k1 + k2 + k3 + k4);
      const double next = theta + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      tip.x += h / 6.0 * (std::cos(theta) + 4.0 * std::cos(middle) + std::cos(next));
      tip.y += h / 6.0 * (std::sin(theta) + 4.0 * std::sin(middle) + std::sin(next));
      theta = next;
      rate += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
    }
    return rate;
  };
  double low = 0.0, high = 2.0 * load;
  Tip tip;
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (shoot(middle, tip) > 0.0 ? high : low) = middle;
  }
  return tip;
}

TEST(FiniteStatics, CantileverIsTheElastica) {
  constexpr double thickness = 0.02, young = 1.2e4, load = 4.0;  // PL²/EI
  const std::string mesh = mesh_geometry(
      "finite-beam",
      fmt::format(
          "Point(1) = {{0, 0, 0}};\nPoint(2) = {{1, 0, 0}};\nPoint(3) = {{1, {0}, 0}};\nPoint(4) = {{0, {0}, 0}};\n"
          "Line(1) = {{1, 2}};\nLine(2) = {{2, 3}};\nLine(3) = {{3, 4}};\nLine(4) = {{4, 1}};\nCurve Loop(1) = {{1, 2, "
          "3, 4}};\nPlane Surface(1) = {{1}};\nTransfinite Curve{{1, 3}} = 41;\nTransfinite Curve{{2, 4}} = 2;\n"
          "Transfinite Surface{{1}};\nRecombine Surface{{1}};\nPhysical Surface(\"body\") = {{1}};\nPhysical "
          "Curve(\"end\") = {{2}};\nPhysical Curve(\"root\") = {{4}};\n",
          thickness),
      1.0, 2);
  const double stiffness = young * std::pow(thickness, 3) / 12.0, traction = load * stiffness / thickness;
  CaseRun run(body(mesh, fmt::format("law = \"neo-hookean\"\nyoung = {}\npoisson = 0.0\n", young),
                   "[[support]]\ngroup = \"root\"\ncomponents = [\"x\", \"y\"]\n" +
                       fmt::format("[[traction]]\ngroup = \"end\"\nvalue = [\"0\", \"{:.17g}\"]\n", traction),
                   "degree = 2\n"));
  const Tip tip = elastica(load);
  Tip found;
  double count = 0.0;
  for (Index node = 0; node < run.problem().nodes.cols(); ++node) {
    if (run.problem().nodes(0, node) < 1.0 - 1e-9) continue;
    found.x += run.problem().nodes(0, node) + run.state().displacement[2 * node];
    found.y += run.state().displacement[2 * node + 1];
    count += 1.0;
  }
  // Shear and stretch of a beam of this thickness are of order (h/L)².
  EXPECT_NEAR(found.x / count, tip.x, 2e-3);
  EXPECT_NEAR(found.y / count, tip.y, 2e-3);
  EXPECT_GT(tip.y, 0.6);
}

/// A block held by friction on the floor alone: for small loads its equilibrium is that of the linear law.
TEST(FiniteStatics, FrictionHoldsABlockAsWithTheLinearLaw) {
  const auto displacement = [](const std::string& law) {
    const CaseRun run(
        body(square(), "law = \"" + law + "\"\nlambda = 1.3\nmu = 0.8\n",
             "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = "
             "\"y0\"\nobstacle = \"floor\"\nfriction = 0.3\n[[traction]]\ngroup = \"y1\"\nvalue = [\"0\", "
             "\"-1e-6\"]\n[[traction]]\ngroup = \"x1\"\nvalue = [\"1.5e-7\", \"0\"]\n"));
    return run.state().displacement;
  };
  const Vector wanted = displacement("linear");
  EXPECT_GT(wanted.norm(), 1e-7);
  for (const std::string law : {"neo-hookean", "saint-venant-kirchhoff"})
    EXPECT_LT((displacement(law) - wanted).norm(), 1e-5 * wanted.norm()) << law;
}

TEST(FiniteStatics, SaysHowFarItCame) {
  // Compressed to zero height.
  expect_error(ErrorKind::not_converged, {"times the loads"}, [&] {
    CaseRun run(body(cube(), "law = \"saint-venant-kirchhoff\"\nlambda = 1.3\nmu = 0.8\n",
                     "[[support]]\ngroup = \"x0\"\ncomponents = [\"x\", \"y\", \"z\"]\n" + support("x1", "x", -1.2) +
                         "[[support]]\ngroup = \"x1\"\ncomponents = [\"y\", \"z\"]\n"));
  });
}

constexpr double width = 0.02, euler = M_PI * M_PI * 1e6 * width * width * width / 12.0 / 4.0;

/// A cantilever column of length 1 under a dead load on top.
CaseRun column(const std::string& law, double load, const std::string& more = "") {
  const std::string mesh = mesh_geometry("column",
                                         "Rectangle(1) = {0, 0, 0, 0.02, 1};\nPhysical Surface(\"body\") = {1};\n"
                                         "Physical Curve(\"y0\") = {1};\nPhysical Curve(\"x1\") = {2};\n"
                                         "Physical Curve(\"y1\") = {3};\n",
                                         0.05, 2);
  return CaseRun(body(mesh, "law = \"" + law + "\"\nyoung = 1e6\npoisson = 0.0\n",
                      support("y0", "x", 0.0) + support("y0", "y", 0.0), "degree = 2\nplane = \"strain\"\n") +
                 fmt::format("[[traction]]\ngroup = \"y1\"\nvalue = [0.0, {:.17g}]\n", -load / width) + more);
}

/// Displacement of the middle of its upper side.
Eigen::Vector2d top_of(const CaseRun& run) {
  Index top = 0;
  const Vector middle = (Vector(2) << 0.5 * width, 1.0).finished();
  (run.problem().nodes.colwise() - middle).colwise().norm().minCoeff(&top);
  return run.state().displacement.segment<2>(2 * top);
}

/// Below Euler's load the column remains straight, beyond it the straight equilibrium is unstable, and the start is the
/// elastica with the angle α at the top: P/P₁ = (2K/π)², deflection 2k/K, height 2E/K − 1, k = sin(α/2).
TEST(FiniteStatics, ColumnsBuckleAtEulersLoad) {
  for (const std::string law : {"saint-venant-kirchhoff", "neo-hookean"}) {
    EXPECT_LT(std::abs(top_of(column(law, 0.97 * euler))[0]), 1e-4) << law;
    for (const double angle : {0.35, 1.05, 1.6}) {
      const double modulus = std::sin(0.5 * angle), k = std::comp_ellint_1(modulus), e = std::comp_ellint_2(modulus);
      const Eigen::Vector2d top = top_of(column(law, euler * std::pow(2.0 * k / M_PI, 2)));
      EXPECT_NEAR(std::abs(top[0]), 2.0 * modulus / k, 8e-3) << law << angle;
      EXPECT_NEAR(1.0 + top[1], 2.0 * e / k - 1.0, 8e-3) << law << angle;
    }
  }
}

/// A wall beside the column catches it: the same check of stability, with contact.
TEST(FiniteStatics, ColumnsBuckleOntoAWall) {
  const CaseRun run = column("saint-venant-kirchhoff", 1.3 * euler,
                             "[obstacle.wall]\ntype = \"plane\"\npoint = [0.15, 0]\nnormal = [-1, 0]\n[[contact]]\n"
                             "group = \"x1\"\nobstacle = \"wall\"\n[obstacle.other]\ntype = \"plane\"\npoint = "
                             "[-0.1, 0]\nnormal = [1, 0]\n[[contact]]\ngroup = \"x1\"\nobstacle = \"other\"\n");
  EXPECT_GT(run.state().forces.normal_reaction.maxCoeff(), 0.0);
  EXPECT_GT(std::abs(top_of(run)[0]), 0.05);
  EXPECT_LT(std::abs(top_of(run)[0]), 0.16);
}

/// A rubber disc in a gap that is lower by a fifth of its diameter: contact with friction alone holds it, and it stays
/// where it starts.
TEST(FiniteStatics, RubberIsSqueezedAndStays) {
  const std::string mesh = mesh_geometry(
      "rubber-disc",
      "Disk(1) = {0, 0, 0, 0.5, 0.5};\nPhysical Surface(\"body\") = {1};\nPhysical Curve(\"skin\") = {1};\n", 0.12, 2);
  for (const double friction : {0.1, 0.6}) {
    std::string text =
        body(mesh, "law = \"neo-hookean\"\nyoung = 1.0\npoisson = 0.45\n", "", "degree = 2\nplane = \"strain\"\n");
    for (const auto& [name, side] : {std::pair{"floor", -1.0}, std::pair{"lid", 1.0}})
      text += fmt::format(
          "[obstacle.{0}]\ntype = \"plane\"\npoint = [0, {1}]\nnormal = [0, {2}]\n[[contact]]\ngroup = \"skin\"\n"
          "obstacle = \"{0}\"\nfriction = {3}\n",
          name, 0.4 * side, -side, friction);
    CaseRun run(text);
    const auto& forces = run.state().forces;
    Vector force = Vector::Zero(run.problem().dof_count());
    forces.rows->add_force(forces.normal_reaction, forces.tangential_reaction, force);
    EXPECT_GT(force.cwiseMax(0.0).sum(), 0.05);
    EXPECT_NEAR(force.reshaped(2, force.size() / 2).row(1).sum(), 0.0, 1e-10);
    EXPECT_LT(run.state().displacement.head<2>().norm(), 0.3);
    run.run([&] { EXPECT_LT(run.simulation().account().energies(run.state()).kinetic, 1e-16); });
  }
}

}  // namespace ricochet::test_support::finite_statics_test
