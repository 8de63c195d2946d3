#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/simulation/history/momentum_account.hpp"
#include "support/case_run.hpp"
#include "support/convergence.hpp"
#include "support/errors.hpp"
#include "support/motion_totals.hpp"

/// @file Follower pressure: inflated spheres and cylinders compared with the solution of the radial equation, and the
/// balances of every step.
namespace ricochet::test_support::follower_pressure_test {

constexpr double inner = 1.0, outer = 2.0;

/// A thick sphere (`hoops` = 2) or cylinder in plane strain (1) of W = (μ/2)(I₁ − 3 − 2 ln J) + (λ/4)(J² − 1 − 2 ln J)
/// under a pressure inside: with the stretches l = r′ and h = r/R and the nominal stresses P_l = ∂W/∂l,
///   P_l′ + hoops (P_l − P_h)/R = 0,   P_l = −p h^hoops at the inner radius, 0 at the outer one,
/// solved by shooting with the Runge–Kutta method.
class InflatedShell {
 public:
  InflatedShell(int hoops, double lambda, double mu, double pressure)
      : hoops_(hoops), lambda_(lambda), mu_(mu), pressure_(pressure) {
    // As long as the shell is stable, the stress at the outer radius rises with the deformed inner radius.
    double low = inner, high = inner;
    while (shoot(high) <= 0.0) high += 0.01;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (shoot(middle) > 0.0 ? high : low) = middle;
    }
    shoot(low);
  }
  /// The displacement r − R.
  [[nodiscard]] double displacement(double radius) const {
    const double at = std::clamp((radius - inner) / step(), 0.0, steps - 1e-9);
    const auto k = std::size_t(at);
    const double t = at - double(k), h = step();
    const double a = place_[k], b = place_[k + 1], c = h * slope_[k], d = h * slope_[k + 1];
    return a + t * (c + t * (3.0 * (b - a) - 2.0 * c - d + t * (2.0 * (a - b) + c + d))) - radius;
  }

 private:
  static constexpr int steps = 400;
  static double step() { return (outer - inner) / steps; }
  [[nodiscard]] double volume(double l, double h) const { return l * std::pow(h, hoops_); }
  [[nodiscard]] double nominal(double stretch, double j) const {
    return mu_ * (stretch - 1.0 / stretch) + 0.5 * lambda_ * (j * j - 1.0) / stretch;
  }
  /// Radial stretch l for a given P_l, which increases with l.
  [[nodiscard]] double stretch_of(double stress, double h) const {
    double low = 1e-3, high = 1e3;
    for (int k = 0; k < 60; ++k) {
      const double middle = std::sqrt(low * high);
      (nominal(middle, volume(middle, h)) > stress ? high : low) = middle;
    }
    double l = std::sqrt(low * high);
    for (int k = 0; k < 2; ++k) {
      const double j = volume(l, h);
      const double tangent = mu_ * (1.0 + 1.0 / (l * l)) + 0.5 * lambda_ * (j * j + 1.0) / (l * l);
      l -= (nominal(l, j) - stress) / tangent;
    }
    return l;
  }
  double shoot(double start) {
    place_.assign(1, start);
    double r = start, stress = -pressure_ * std::pow(start / inner, hoops_);
    slope_.assign(1, stretch_of(stress, start / inner));
    const auto rate = [&](double radius, double place, double p) {
      const double h = place / radius, l = stretch_of(p, h);
      return std::pair{l, -hoops_ * (p - nominal(h, volume(l, h))) / radius};
    };
    for (int k = 0; k < steps; ++k) {
      const double radius = inner + k * step(), s = step();
      const auto [a1, b1] = rate(radius, r, stress);
      const auto [a2, b2] = rate(radius + 0.5 * s, r + 0.5 * s * a1, stress + 0.5 * s * b1);
      const auto [a3, b3] = rate(radius + 0.5 * s, r + 0.5 * s * a2, stress + 0.5 * s * b2);
      const auto [a4, b4] = rate(radius + s, r + s * a3, stress + s * b3);
      r += s / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      stress += s / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
      place_.push_back(r);
      slope_.push_back(stretch_of(stress, r / (radius + s)));
    }
    return stress;
  }

  int hoops_;
  double lambda_, mu_, pressure_;
  std::vector<double> place_, slope_;
};

/// A quarter of the section, n cells through the thickness.
std::string ring(int n, int order, bool simplices) {
  return mesh_geometry(
      fmt::format("ring{}-{}{}", n, order, simplices ? "t" : "q"),
      fmt::format("Point(1) = {{0, 0, 0}};\nPoint(2) = {{{0}, 0, 0}};\nPoint(3) = {{{1}, 0, 0}};\nPoint(4) = {{0, {1}, "
                  "0}};\nPoint(5) = {{0, {0}, 0}};\nLine(1) = {{2, 3}};\nCircle(2) = {{3, 1, 4}};\nLine(3) = {{4, "
                  "5}};\nCircle(4) = {{5, 1, 2}};\nCurve Loop(1) = {{1, 2, 3, 4}};\nPlane Surface(1) = "
                  "{{1}};\nTransfinite Curve{{1, 3}} = {2};\nTransfinite Curve{{2, 4}} = {3};\nTransfinite "
                  "Surface{{1}};\n{4}Physical Surface(\"body\") = {{1}};\nPhysical Curve(\"y0\") = {{1}};\nPhysical "
                  "Curve(\"x0\") = {{3}};\nPhysical Curve(\"inside\") = {{4}};\nPhysical Curve(\"outside\") = {{2}};\n",
                  inner, outer, n + 1, 2 * n + 1, simplices ? "" : "Recombine Surface{1};\n"),
      1.0, order);
}

/// An eighth of the sphere.
std::string eighth(double size, int order) {
  return mesh_geometry(
      fmt::format("eighth{:.0f}-{}", 1000.0 * size, order),
      fmt::format("Sphere(1) = {{0, 0, 0, {1}, 0, Pi/2, Pi/2}};\nSphere(2) = {{0, 0, 0, {0}, 0, Pi/2, "
                  "Pi/2}};\nBooleanDifference(3) = {{Volume{{1}}; Delete;}}{{Volume{{2}}; Delete;}};\n"
                  "e = 1e-3;\nPhysical Volume(\"body\") = {{3}};\nPhysical Surface(\"x0\") = {{Surface In "
                  "BoundingBox{{-e, -e, -e, e, 3, 3}}}};\nPhysical Surface(\"y0\") = {{Surface In BoundingBox{{-e, -e, "
                  "-e, 3, e, 3}}}};\nPhysical Surface(\"z0\") = {{Surface In BoundingBox{{-e, -e, -e, 3, 3, "
                  "e}}}};\nPhysical Surface(\"inside\") = {{Surface In BoundingBox{{-e, -e, -e, {0}+e, {0}+e, "
                  "{0}+e}}}};\n",
                  inner, outer),
      size, order);
}

struct Shell {
  std::string mesh;
  int degree = 1;
  std::string plane = "";
  std::vector<std::string> supports = {"y"};
  double lambda = 1.5, mu = 1.0, pressure = 0.6;
};

std::string case_of(const Shell& shell) {
  std::string text = fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = {}\n{}[[material]]\ngroup = \"body\"\ndensity = 1.0\nlaw = "
      "\"neo-hookean\"\nlambda = {}\nmu = {}\n[[pressure]]\ngroup = \"inside\"\nvalue = \"{}\"\n",
      shell.mesh, shell.degree, shell.plane.empty() ? "" : "plane = \"" + shell.plane + "\"\n", shell.lambda, shell.mu,
      shell.pressure);
  for (const std::string& axis : shell.supports)
    text += fmt::format("[[support]]\ngroup = \"{0}0\"\ncomponents = [\"{0}\"]\n", axis);
  return text +
         "[initial]\ndisplacement = \"static\"\n[mass]\ntype = \"consistent\"\n[time]\nscheme = \"newmark\"\npreset = "
         "\"trapezoidal\"\nstep = 0.01\nend = 0.01\n";
}

/// Largest error at a node, relative to the displacement of the inner surface.
double inflation_error(const Shell& shell) {
  const int hoops = shell.supports.size() == 3 || shell.plane == "axisymmetric" ? 2 : 1;
  const InflatedShell exact(hoops, shell.lambda, shell.mu, shell.pressure);
  CaseRun run(case_of(shell));
  const Points& nodes = run.problem().nodes;
  double error = 0.0;
  for (Index node = 0; node < nodes.cols(); ++node) {
    const Vector at = nodes.col(node), u = run.state().displacement.segment(node * at.size(), at.size());
    // The nodes added by degree 2 to straight cells do not lie on the circle.
    error = std::max(error, (u - exact.displacement(at.norm()) * at.normalized()).norm());
  }
  return error / exact.displacement(inner);
}

TEST(FollowerPressure, InflatesThickSpheresByTheirSection) {
  EXPECT_GT(InflatedShell(2, 1.5, 1.0, 0.6).displacement(inner), 0.3);
  for (const int degree : {1, 2}) {
    for (const bool simplices : {false, true}) {
      Convergence errors(fmt::format("sphere, axisymmetric, degree {}, {}", degree, simplices ? "triangles" : "quads"));
      double error = 0.0;
      for (const int n : degree == 1 ? std::vector{4, 8, 16} : std::vector{2, 4, 8}) {
        error = inflation_error({.mesh = ring(n, degree, simplices), .degree = degree, .plane = "axisymmetric"});
        errors.add(error);
      }
      // For degree 1 the orders rise to 2.
      EXPECT_GT(errors.last_order(), degree == 1 ? 1.75 : 2.6);
      EXPECT_LT(error, degree == 1 ? 1.5e-2 : 5e-4);
    }
  }
}

TEST(FollowerPressure, InflatesThickCylinders) {
  for (const int degree : {1, 2}) {
    for (const bool simplices : {false, true}) {
      Convergence errors(
          fmt::format("cylinder, plane strain, degree {}, {}", degree, simplices ? "triangles" : "quads"));
      double error = 0.0;
      for (const int n : degree == 1 ? std::vector{4, 8, 16} : std::vector{2, 4, 8}) {
        error = inflation_error(
            {.mesh = ring(n, degree, simplices), .degree = degree, .supports = {"x", "y"}, .pressure = 0.45});
        errors.add(error);
      }
      // For degree 1 the orders rise to 2.
      EXPECT_GT(errors.last_order(), degree == 1 ? 1.75 : 2.6);
      EXPECT_LT(error, degree == 1 ? 1.5e-2 : 5e-4);
    }
  }
}

TEST(FollowerPressure, InflatesThickSpheresInSpace) {
  for (const int degree : {1, 2}) {
    Convergence errors(fmt::format("sphere, an eighth, degree {}", degree));
    double error = 0.0;
    // Gmsh generates each mesh anew: halving the mesh size halves the cells on average.
    for (const double size : degree == 1 ? std::vector{0.25, 0.125} : std::vector{0.5, 0.25}) {
      error = inflation_error({.mesh = eighth(size, degree), .degree = degree, .supports = {"x", "y", "z"}});
      errors.add(error);
    }
    EXPECT_GT(errors.last_order(), degree == 1 ? 1.5 : 2.2);
    EXPECT_LT(error, degree == 1 ? 6e-2 : 5e-3);
  }
}

/// Near the limit pressure (about 0.77 μ) the shell has hardly any stiffness left, and beyond it there is no
/// equilibrium: the error states the fraction of the pressure for which there is one.
TEST(FollowerPressure, GoesAsFarAsTheShellHolds) {
  Shell shell{.mesh = ring(4, 2, false), .degree = 2, .plane = "axisymmetric", .pressure = 0.76};
  EXPECT_LT(inflation_error(shell), 1e-2);
  shell.pressure = 0.84;
  expect_error(ErrorKind::not_converged, {"beyond 0.9"}, [&] { CaseRun run(case_of(shell)); });
}

struct Flight {
  int dimension = 2;
  std::string scheme = "reduced-kane";
  double height = 10.0;
  std::string pressure = "6*sin(20*t+0.3)", more = "";
};

/// A spinning, stretched block of E = 100, ρ = 1 above a floor, with a pressure on its whole boundary.
std::string case_of(const Flight& flight) {
  const bool plane = flight.dimension == 2;
  const std::string mesh = plane
                               ? mesh_geometry("pressed-block-2d",
                                               "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                               "Physical Curve(\"bottom\") = {1};\n",
                                               0.125, 1)
                               : mesh_geometry("pressed-block-3d",
                                               "Box(1) = {0, 0, 0, 1, 0.5, 0.6};\nPhysical Volume(\"body\") = {1};\n"
                                               "Physical Surface(\"bottom\") = {3};\n",
                                               0.25, 1);
  const bool has_inertia = flight.scheme == "midpoint" || flight.scheme == "kane";
  return fmt::format(
             "[mesh]\nfile = \"{}\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = "
             "100.0\npoisson = 0.3\nlaw = \"neo-hookean\"\n[obstacle.floor]\ntype = \"plane\"\npoint = "
             "{}\nnormal = {}\n[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n{}[[pressure]]\ngroup "
             "= \"boundary\"\nvalue = \"{}\"\n",
             mesh, fmt::format(fmt::runtime(plane ? "[0, {}]" : "[0, {}, 0]"), -flight.height),
             plane ? "[0, 1]" : "[0, 1, 0]", flight.more, flight.pressure) +
         (plane ? "[initial]\ndisplacement = [\"0.02*sin(5*x)\", \"0.02*sin(5*y)\"]\nvelocity = [\"0.3-2*(y-0.25)\", "
                  "\"-0.5+2*(x-0.5)\"]\n"
                : "[initial]\ndisplacement = [\"0.02*sin(5*x)\", \"0.02*sin(5*y)\", \"0.02*sin(4*z+x)\"]\nvelocity "
                  "= [\"0.3-2*(y-0.25)\", \"-0.5+2*(x-0.5)\", \"0.2\"]\n") +
         fmt::format("[mass]\ntype = \"{}\"\n[time]\nscheme = \"{}\"\n{}step = 0.01\nend = 1.0\n",
                     has_inertia ? "consistent" : "equivalent", flight.scheme,
                     flight.scheme == "newmark" ? "preset = \"trapezoidal\"\n" : "");
}

double account_error(CaseRun& run) {
  EnergyAccount& account = run.simulation().account();
  return account.residual(account.energies(run.state()));
}

/// A pressure on the whole boundary has neither resultant nor moment, and the energy account contains its work.
TEST(FollowerPressure, InFlightMomentaAreKeptAndTheAccountCloses) {
  for (const int dimension : {2, 3}) {
    for (const std::string scheme :
         {"reduced-kane", "mean-reaction", "reduced-midpoint", "midpoint", "kane", "newmark", "generalized-alpha"}) {
      CaseRun run(case_of({.dimension = dimension, .scheme = scheme}));
      const Momenta first(run);
      const double size = run.simulation().account().energies(run.state()).total();
      const bool keeps_moments = run.scheme().traits().conserves_moments_at_finite_strain;
      double worst = 0.0, work = 0.0, turned = 0.0, drifted = 0.0;
      run.run([&] {
        const Momenta now(run);
        if (scheme != "generalized-alpha") drifted = std::max(drifted, (now.linear - first.linear).norm());
        if (keeps_moments) turned = std::max(turned, (now.angular - first.angular).norm());
        // The accounts of these two omit the difference between the work of the midpoint force and the change of
        // elastic energy.
        if (scheme != "midpoint" && scheme != "kane") worst = std::max(worst, std::abs(account_error(run)));
        work = std::max(work, std::abs(run.simulation().account().works().load));
      });
      EXPECT_LT(drifted, 1e-12) << scheme;
      EXPECT_LT(turned, 1e-11) << scheme;
      EXPECT_LT(worst, 1e-11 * size) << scheme;
      EXPECT_GT(work, 0.01 * size) << scheme;
    }
  }
}

/// The pressure also acts on massless contact nodes.
TEST(FollowerPressure, ABodyThatBouncesUnderPressure) {
  for (const int dimension : {2, 3}) {
    for (const std::string scheme : {"reduced-kane", "mean-reaction", "reduced-midpoint", "newmark"}) {
      for (const std::string friction : {"", "friction = 0.4\n"}) {
        if (!friction.empty() && scheme != "reduced-kane") continue;
        CaseRun run(case_of({.dimension = dimension, .scheme = scheme, .height = 0.05, .more = friction}));
        const Momenta first(run);
        const double size = run.simulation().account().energies(run.state()).total();
        MomentumAccount momentum(run.problem(), run.scheme(), run.state());
        double largest_force = 0.0, created = 0.0;
        run.run(
            [&] {
              momentum.enter_step(run.state());
              const std::string what = scheme + friction + " step " + std::to_string(run.state().step);
              const Momenta now(run);
              EXPECT_LT((now.linear - first.linear - momentum.impulse().force).norm(), 1e-12) << what;
              if (run.scheme().traits().conserves_moments_at_finite_strain) {
                EXPECT_LT((now.angular - first.angular - momentum.impulse().moment).norm(), 1e-11) << what;
              }
              EXPECT_NEAR(account_error(run), 0.0, 1e-11 * size) << what;
              largest_force = std::max(largest_force, run.state().forces.normal_reaction.sum());
              created = std::max(created, run.simulation().account().method_energy(run.state()));
            },
            false);
        EXPECT_GT(largest_force, 0.1) << scheme;
        EXPECT_LT(scheme == "newmark" ? 0.0 : created, 1e-11 * size) << scheme;
      }
    }
  }
}

/// With the linear law a pressure is a traction along the normal of the undeformed surface.
TEST(FollowerPressure, IsADeadLoadWithTheLinearLaw) {
  const std::string mesh = ring(4, 1, false);
  const std::string rest =
      "[[support]]\ngroup = \"x0\"\ncomponents = [\"x\"]\n[[support]]\ngroup = \"y0\"\ncomponents = "
      "[\"y\"]\n[initial]\ndisplacement = \"static\"\n[time]\nstep = 0.01\nend = 0.01\n";
  const std::string start =
      "[mesh]\nfile = \"" + mesh + "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 1.0\npoisson = 0.3\n";
  const CaseRun pressed(start +
                        "[[pressure]]\ngroup = \"y0\"\nvalue = \"0.2*x\"\n[[pressure]]\ngroup = "
                        "\"x0\"\nvalue = \"0.3+t\"\n" +
                        rest);
  const CaseRun pushed(start +
                       "[[traction]]\ngroup = \"y0\"\nvalue = [\"0\", \"0.2*x\"]\n[[traction]]\ngroup = "
                       "\"x0\"\nvalue = [\"0.3+t\", \"0\"]\n" +
                       rest);
  Vector one, other;
  pressed.problem().loads.total(0.7, one);
  pushed.problem().loads.total(0.7, other);
  EXPECT_GT(one.norm(), 0.1);
  EXPECT_LT((one - other).norm(), 1e-14);
  EXPECT_EQ(pressed.problem().pressure, nullptr);
}

TEST(FollowerPressure, SaysWhatIsWrongWithIt) {
  const auto message = [](const std::string& pressure) -> std::string {
    std::string text = case_of(Shell{.mesh = ring(2, 1, false), .supports = {"x", "y"}});
    return message_of([&] { CaseRun run(text.insert(text.find("[[support]]"), pressure)); });
  };
  EXPECT_TRUE(has(message("[[pressure]]\ngroup = \"nowhere\"\nvalue = \"1\"\n"), "nowhere"));
  EXPECT_TRUE(has(message("[[pressure]]\ngroup = \"outside\"\nvalue = \"z\"\n"), "depends on z"));
  EXPECT_TRUE(has(message("[[pressure]]\ngroup = \"outside\"\nvalue = \"1/(x-x)\"\n"), "value"));
  EXPECT_TRUE(has(message("[[pressure]]\ngroup = \"outside\"\n"), "value"));
}

}  // namespace ricochet::test_support::follower_pressure_test
