#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/log.hpp"
#include "ricochet/run/run_case.hpp"
#include "support/case_run.hpp"

/// @file Curved obstacles: a small block that slides in a bowl is a point mass on a circle.
namespace ricochet::test_support::sphere_test {

constexpr double gravity = 9.81;
constexpr double start_angle = 0.3;

/// A block of width 2b and height b, two corners on a circle of radius 1 about (0, 1), rotated by the start angle.
std::string bowl_case(double b, double step, double friction, const std::string& time) {
  const double sagitta = 1.0 - std::sqrt(1.0 - b * b);
  std::string geometry = "Rectangle(1) = {-" + std::to_string(b) + ", 0, 0, " + std::to_string(2 * b) + ", " +
                         std::to_string(b) + "}; Physical Surface(\"body\") = {1}; Physical Curve(\"bottom\") = {1};";
  const std::string mesh = mesh_geometry("block", geometry, 0.5 * b, 1);
  const double angle = start_angle, d = 1.0 - sagitta;
  std::string text = "[mesh]\nfile = \"" + mesh + "\"\n";
  char place[200];
  std::snprintf(place, sizeof place, "turn = { angle = %.17g }\nmove = [%.17g, %.17g]\n", angle * 180.0 / M_PI,
                d * std::sin(angle), 1.0 - d * std::cos(angle));
  text += place;
  text += R"([[material]]
group = "body"
density = 1000
young = 1e5
poisson = 0.3
[obstacle.bowl]
type = "sphere"
centre = [0, 1]
radius = 1
side = "inside"
[[contact]]
group = "bottom"
obstacle = "bowl"
friction = )" +
          std::to_string(friction) +
          R"(
[load]
gravity = [0, -9.81]
[time]
end = 3
step = )" +
          std::to_string(step) + "\n" + time;
  return text;
}

const std::string dissipative = "scheme = \"newmark\"\nbeta = 0.3025\ngamma = 0.6\n";

/// Mean velocity and angle of the block about the centre of the circle, from its mass and momentum.
struct Pendulum {
  explicit Pendulum(const CaseRun& run) : run_(run), u_(run.problem().dof_count()) {
    for (Index i = 0; i < u_.size(); ++i) u_[i] = i % 2 == 0 ? 1.0 : 0.0;
    run.problem().mass.multiply(u_, weight_);
    mass_ = weight_.dot(u_);
    Vector x(u_.size());
    for (Index i = 0; i < u_.size(); ++i) x[i] = run.problem().nodes(i % 2, i / 2);
    start_ = weight_.dot(x) / mass_;
  }
  [[nodiscard]] double x() const { return start_ + weight_.dot(run_.state().displacement) / mass_; }
  [[nodiscard]] double velocity() const { return weight_.dot(run_.state().velocity) / mass_; }

  const CaseRun& run_;
  Vector u_, weight_;
  double mass_ = 0.0, start_ = 0.0;
};

/// Largest values of a run's steps.
struct EnergyWatch {
  double residual = 0.0, kinetic = 0.0;

  void look(CaseRun& run) {
    EnergyAccount& account = run.simulation().account();
    const Energies now = account.energies(run.state());
    residual = std::max(residual, std::abs(account.residual(now)));
    kinetic = std::max(kinetic, now.kinetic);
  }
};

struct Swing {
  std::vector<double> times, angles;  ///< of the turning points
  EnergyWatch energy;
  double penetration = 0.0;
};

Swing swing(CaseRun& run, double length) {
  Swing result;
  const Pendulum pendulum(run);
  double before = 0.0, time_before = 0.0;
  Vector gap;
  run.run([&] {
    const double v = pendulum.velocity();
    const double time = run.state().time;
    if (before * v < 0.0) {
      result.times.push_back(time_before - before * (time - time_before) / (v - before));
      result.angles.push_back(std::asin(pendulum.x() / length));
    }
    before = v;
    time_before = time;
    result.energy.look(run);
    run.problem().gaps(run.state().displacement, time, gap);
    for (Index i = 0; i < gap.size(); ++i)
      result.penetration = std::max(result.penetration, -gap[i] - run.problem().contact.rows->gap_rounding[i]);
  });
  return result;
}

/// Half period of the physical pendulum without friction: distance l of the centre of gravity, radius of gyration k,
/// amplitude a.
double half_period(double l, double k_squared, double a) {
  // Quarter periods by the arithmetic-geometric mean.
  double x = 1.0, y = std::cos(0.5 * a);
  for (int i = 0; i < 8; ++i) {
    const double mean = 0.5 * (x + y);
    y = std::sqrt(x * y);
    x = mean;
  }
  return M_PI / x * std::sqrt((l * l + k_squared) / (gravity * l));
}

TEST(Sphere, ABlockSwingsInABowlWithThePeriodOfItsPointMass) {
  std::vector<double> errors;
  for (const double b : {4e-3, 2e-3}) {
    CaseRun run(bowl_case(b, 1e-4, 0.0, dissipative));
    const double l = std::sqrt(1.0 - b * b) - 0.5 * b;
    const Swing found = swing(run, l);
    ASSERT_GE(found.times.size(), 2u);
    const double exact = half_period(l, (4 * b * b + b * b) / 12.0, start_angle);
    errors.push_back(std::abs(found.times[1] - found.times[0] - exact) / exact);
    EXPECT_LE(found.energy.residual, 1e-10 * found.energy.kinetic);
    EXPECT_LE(found.penetration, 0.0);
    EXPECT_NEAR(std::abs(found.angles[1]), start_angle, 5e-3);
  }
  // Small strain enlarges a rotating body: an error of the size of the block.
  EXPECT_LE(errors[1], 1e-3);
  EXPECT_NEAR(errors[0] / errors[1], 2.0, 0.3);
}

/// A disc of radius 0.01 at the centre of a sphere.
std::string disc_case(const std::string& radius, const std::string& side, double end) {
  const std::string geometry =
      "Disk(1) = {0, 0, 0, 0.01}; Physical Surface(\"disc\") = {1}; Physical Curve(\"skin\") = {1};";
  return "[mesh]\nfile = \"" + mesh_geometry("disc", geometry, 0.003, 1) + R"("
[[material]]
group = "disc"
density = 1000
young = 1e8
poisson = 0.3
[obstacle.hollow]
type = "sphere"
centre = [0, 0]
radius = )" +
         radius + "\nside = \"" + side + R"("
[[contact]]
group = "skin"
obstacle = "hollow"
[initial]
velocity = [1.0, -0.1]
[time]
scheme = "newmark"
preset = "trapezoidal"
step = 2e-4
end = )" +
         std::to_string(end) + "\n";
}

/// A disc in a slightly larger hollow, thrown so hard that its contact forces are stiffer than the step and iterations
/// of tangent planes diverge: they are accelerated, and the conditions hold nevertheless.
TEST(Sphere, ADiscThrownIntoATightHollowStaysInside) {
  CaseRun run(disc_case("0.0105", "inside", 0.05));
  EnergyWatch energy;
  double penetration = 0.0;
  Vector gap;
  run.run([&] {
    energy.look(run);
    run.problem().gaps(run.state().displacement, run.state().time, gap);
    penetration = std::max(penetration, -gap.minCoeff());
  });
  EXPECT_EQ(run.state().step, 250);
  EXPECT_LE(energy.residual, 1e-10 * energy.kinetic);
  EXPECT_LE(penetration, 1e-15);
}

/// All boundary nodes touch and none is inside, although the body is.
TEST(Sphere, ADiscThatFillsABallIsToldToBeInside) {
  Session session(write_temporary("filled.toml", disc_case("0.01", "outside", 2e-4)));
  const std::string output = testing::TempDir() + "filled";
  (void)run_case(session, {.output_directory = output, .force = true, .quiet = true});
  const auto& told = session.warnings();
  EXPECT_TRUE(std::ranges::any_of(told, [](const std::string& warning) {
    return warning.find("the body is inside the obstacle, not next to it") != std::string::npos;
  }));
}

/// Turning points of θ'' = −(g/l) sin θ − F sgn(θ') ((g/l) cos θ + θ'²), by the Runge–Kutta method.
std::vector<double> turning_points(double l, double friction) {
  double angle = start_angle, rate = -1e-12;
  std::vector<double> result;
  const double h = 1e-5;
  for (int step = 0; step < 300000; ++step) {
    const double sign = rate > 0.0 ? 1.0 : -1.0;
    const auto acceleration = [&](double x, double v) {
      return -gravity / l * std::sin(x) - friction * sign * (gravity / l * std::cos(x) + v * v);
    };
    const double a1 = acceleration(angle, rate), v1 = rate;
    const double v2 = rate + 0.5 * h * a1, a2 = acceleration(angle + 0.5 * h * v1, v2);
    const double v3 = rate + 0.5 * h * a2, a3 = acceleration(angle + 0.5 * h * v2, v3);
    const double v4 = rate + h * a3, a4 = acceleration(angle + h * v3, v4);
    angle += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    const double next = rate + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    if (next * rate < 0.0 && step > 10) {
      result.push_back(angle);
      if (std::abs(std::tan(angle)) <= friction) return result;
    }
    rate = next;
  }
  return result;
}

class BowlScheme : public ::testing::TestWithParam<std::string> {};

TEST_P(BowlScheme, ABlockLosesItsAmplitudeToFrictionAsItsPointMassDoes) {
  const double b = 2e-3, friction = 0.05;
  CaseRun run(bowl_case(b, 4e-5, friction, GetParam()));
  const double l = std::sqrt(1.0 - b * b) - 0.5 * b;
  const Swing found = swing(run, l);
  const std::vector<double> exact = turning_points(l, friction);
  ASSERT_GE(found.angles.size(), 2u);
  EXPECT_NEAR(found.angles[0], exact[0], 2e-3);
  EXPECT_NEAR(found.angles[1], exact[1], 2e-3);
  EXPECT_LE(found.energy.residual, 1e-10 * found.energy.kinetic);
}

INSTANTIATE_TEST_SUITE_P(All, BowlScheme,
                         ::testing::Values(dissipative, "scheme = \"newmark\"\npreset = \"trapezoidal\"\n",
                                           "scheme = \"klr-conserving\"\n[mass]\ntype = \"consistent\"\n",
                                           // While the block is slow, its projections are of the size of rounding.
                                           "scheme = \"contact-stabilized\"\n[mass]\ntype = \"consistent\"\n"));

}  // namespace ricochet::test_support::sphere_test
