#include "ricochet/scheme/reduced/velocity_correction.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "support/case_run.hpp"

/// @file Velocity corrections make momenta and energy of a step exact.
namespace ricochet::test_support::velocity_correction_test {

struct Kind {
  std::string name, plane, supports;
};

/// Method and initial conditions: any, for tests of a velocity that they choose.
const std::string any_method = "scheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 0.01\nend = 0.1\n";

CaseRun run_of(const Kind& kind, const std::string& mass, const std::string& method = any_method) {
  const bool flat = kind.name != "space";
  const std::string mesh =
      flat ? mesh_geometry("corrected-2d",
                           "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                           "Physical Curve(\"bottom\") = {1};\nPhysical Curve(\"left\") = {4};\n",
                           0.2, 1)
           : mesh_geometry("corrected-3d",
                           "Box(1) = {0, 0, 0, 1, 0.5, 0.6};\nPhysical Volume(\"body\") = {1};\n"
                           "Physical Surface(\"bottom\") = {3};\nPhysical Surface(\"left\") = {1};\n",
                           0.3, 1);
  return CaseRun("[mesh]\nfile = \"" + mesh + "\"\nplane = \"" + (flat ? kind.plane : "strain") +
                 "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\nlaw = "
                 "\"neo-hookean\"\n[obstacle.floor]\ntype = \"plane\"\n" +
                 (flat ? "point = [0, -9]\nnormal = [0, 1]\n" : "point = [0, -9, 0]\nnormal = [0, 1, 0]\n") +
                 "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" + kind.supports + "[mass]\ntype = \"" +
                 mass + "\"\n[time]\n" + method);
}

/// Sum and moment about the origin of forces or momenta at these positions.
Eigen::Matrix<double, 6, 1> resultants(const SemidiscreteProblem& problem, const Vector& positions,
                                       const Vector& forces) {
  const Index d = problem.dimension;
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    Eigen::Vector3d at = Eigen::Vector3d::Zero(), own = Eigen::Vector3d::Zero();
    at.head(d) = positions.segment(node * d, d);
    own.head(d) = forces.segment(node * d, d);
    sum.head(3) += own;
    sum.tail(3) += at.cross(own);
  }
  if (problem.axisymmetric) sum[0] = sum[5] = 0.0;  // they cancel over the ring
  return sum;
}

/// Momentum and angular momentum of a velocity.
Eigen::Matrix<double, 6, 1> momenta(const SemidiscreteProblem& problem, const Vector& positions,
                                    const Vector& velocity) {
  Vector momentum;
  problem.mass.multiply(velocity, momentum);
  return resultants(problem, positions, momentum);
}

/// Body of a run, with corrections of its velocities.
struct Moving {
  explicit Moving(const CaseRun& run) : problem(run.problem()), bodies(problem), correction(problem, bodies) {}

  /// Random values, zero at supports.
  [[nodiscard]] Vector random(double size = 1.0) const {
    Vector values = size * Vector::Random(problem.dof_count());
    for (const Index dof : problem.supports.dofs()) values[dof] = 0.0;
    return values;
  }
  [[nodiscard]] Vector positions(const Vector& displacement) const { return problem.nodes.reshaped() + displacement; }
  void expect_supported(const Vector& change) const {
    for (const Index dof : problem.supports.dofs()) EXPECT_EQ(change[dof], 0.0);
    for (const Index dof : problem.massless_dofs) EXPECT_EQ(change[dof], 0.0);
  }
  void expect_momentum_of(const Vector& change) const {
    Vector momentum;
    problem.mass.multiply(change, momentum);
    EXPECT_LT((correction.momentum() - momentum).norm(), 1e-13 * momentum.norm());
  }

  const SemidiscreteProblem& problem;
  BodyRotations bodies;
  VelocityCorrection correction;
};

/// Tests free and supported bodies of each kind, with each kind of mass.
void for_each_body(const std::function<void(Moving&)>& test) {
  const std::string left = "[[support]]\ngroup = \"left\"\ncomponents = [\"x\"]\n";
  for (const Kind& kind :
       {Kind{"plane", "strain", ""}, Kind{"held", "strain", left}, Kind{"ring", "axisymmetric", left},
        Kind{"space", "strain", ""}, Kind{"space", "strain", left}}) {
    for (const std::string mass : {"equivalent", "consistent"}) {
      SCOPED_TRACE(kind.name + kind.supports + mass);
      const CaseRun run = run_of(kind, mass);
      Moving moving(run);
      srand(7);
      test(moving);
    }
  }
}

TEST(VelocityCorrection, ChangesTheEnergyAndNeitherMomentaNorSupports) {
  for_each_body([](Moving& moving) {
    VelocityCorrection& correction = moving.correction;
    const Vector velocity = moving.random(), displacement = moving.random(0.1);
    const auto kinetic = [&](const Vector& v) { return 0.5 * moving.problem.mass.quadratic_form(v); };
    const double energy = kinetic(velocity);
    correction.start(displacement);
    for (const double change : {1e-3 * energy, -1e-3 * energy, 1e-14 * energy}) {
      ASSERT_TRUE(correction.find(velocity, change));
      const Vector& added = correction.value();
      EXPECT_NEAR(kinetic(velocity + added) - energy, change, 1e-15 * energy);
      EXPECT_LT(momenta(moving.problem, moving.positions(displacement), added).norm(), 1e-13 * added.norm());
      EXPECT_GT(added.norm(), 0.0);
      moving.expect_supported(added);
      moving.expect_momentum_of(added);
    }
    EXPECT_FALSE(correction.find(velocity, 2.0 * energy)) << "much of what moves would be another motion";
  });
}

/// Rigid motion has no energy that a correction without momentum could remove.
TEST(VelocityCorrection, TakesNothingOfRigidMotion) {
  const CaseRun run = run_of({"plane", "strain", ""}, "equivalent");
  Moving moving(run);
  Vector velocity(run.problem().dof_count());
  for (Index node = 0; node < run.problem().nodes.cols(); ++node)
    velocity.segment<2>(2 * node) << 3.0 - 2.0 * run.problem().nodes(1, node), 2.0 * run.problem().nodes(0, node);
  const double energy = 0.5 * run.problem().mass.quadratic_form(velocity);
  moving.correction.start(Vector::Zero(velocity.size()));
  EXPECT_FALSE(moving.correction.find(velocity, -1e-9 * energy));
}

/// The force acts at the middle of the step, and the velocity at its end.
TEST(VelocityCorrection, GivesBodiesTheMomentaOfAResidual) {
  for_each_body([](Moving& moving) {
    constexpr double step = 0.3;
    const SemidiscreteProblem& problem = moving.problem;
    const Index count = problem.dof_count();
    const Vector end = 0.1 * Vector::Random(count), middle = 0.1 * Vector::Random(count), residual = moving.random();
    moving.correction.start(end);
    Vector reaction = Vector::Zero(problem.supports.size());
    const Vector added = moving.correction.of_momenta(residual, middle, step, reaction);
    Vector impulse = step * residual;
    // Supports take over what the body cannot.
    for (Index i = 0; i < reaction.size(); ++i) impulse[problem.supports.dofs()[std::size_t(i)]] += step * reaction[i];
    // Moments are about the same point in space.
    const auto expected = resultants(problem, moving.positions(middle), impulse);
    const auto found = momenta(problem, moving.positions(end), added);
    EXPECT_LT((found - expected).norm(), 1e-13 * expected.norm());
    moving.expect_supported(added);
    moving.expect_momentum_of(added);
  });
}

/// On nodes with inertia the increment of a step is the mean of its velocities, times its length, before they are
/// corrected: what they have in addition at the end is the correction.
TEST(VelocityCorrection, ReportsTheKineticEnergyThatStepsAdd) {
  constexpr double step = 0.02;  // which no step must be cut for
  for (const std::string scheme : {"reduced-kane", "mean-reaction", "reduced-midpoint"}) {
    CaseRun run = run_of({"plane", "strain", ""}, "equivalent",
                         "scheme = \"" + scheme +
                             "\"\nstep = 0.02\nend = 0.6\n[solver]\nnewton_tolerance = 1e-13\n"
                             "[initial]\ndisplacement = [\"0.3*x\", \"-0.2*y\"]\n");
    const SemidiscreteProblem& problem = run.problem();
    const auto kinetic = [&](const Vector& velocity) { return 0.5 * problem.mass.quadratic_form(velocity); };
    Vector displacement = run.state().displacement, velocity = run.state().velocity;
    double largest = 0.0;
    run.run(
        [&] {
          const Vector straight = (2.0 / step) * (run.state().displacement - displacement) - velocity;
          displacement = run.state().displacement;
          velocity = run.state().velocity;
          const StepCorrections reported = run.scheme().last_step().corrections;
          const double energy = kinetic(velocity) + problem.internal_force->energy(displacement);
          EXPECT_NEAR(reported.velocity_correction, kinetic(velocity) - kinetic(straight), 1e-12 * energy) << scheme;
          EXPECT_NEAR(reported.energy_at_end, energy, 1e-12 * energy) << scheme;
          largest = std::max(largest, std::abs(reported.velocity_correction) / energy);
        },
        false);
    EXPECT_GT(largest, 1e-5) << scheme;
  }
}

/// A step without a residual leaves the velocity as it is, and the end of an earlier step has no effect on a later one.
TEST(VelocityCorrection, FollowsTheEndOfTheStep) {
  for_each_body([](Moving& moving) {
    const Vector residual = moving.random(), other = moving.random(0.3), end = moving.random(0.1);
    Vector reaction = Vector::Zero(moving.problem.supports.size());
    moving.correction.start(end);
    const Vector added = moving.correction.of_momenta(residual, end, 1.0, reaction);
    moving.correction.start(other);
    EXPECT_TRUE(moving.correction.of_momenta(Vector::Zero(end.size()), other, 1.0, reaction).isZero(0.0));
    const Vector& there = moving.correction.of_momenta(residual, other, 1.0, reaction);
    EXPECT_EQ(there == added, moving.problem.axisymmetric) << "the translation along an axis is the same everywhere";
    moving.correction.start(end);
    EXPECT_EQ(moving.correction.of_momenta(residual, end, 1.0, reaction), added);
  });
}

}  // namespace ricochet::test_support::velocity_correction_test
