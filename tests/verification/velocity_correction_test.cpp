#include "ricochet/scheme/reduced/velocity_correction.hpp"

#include <gtest/gtest.h>

#include "support/case_run.hpp"

/// @file Velocity corrections make momenta and energy of a step exact.
namespace ricochet::test_support::velocity_correction_test {

struct Kind {
  std::string name, plane, supports;
};

CaseRun run_of(const Kind& kind, const std::string& mass) {
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
                 mass + "\"\n[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 0.01\nend = 0.1\n");
}

/// Momentum and moment about the origin of M v at these positions.
Eigen::Matrix<double, 6, 1> momenta(const SemidiscreteProblem& problem, const Vector& place, const Vector& velocity) {
  Vector momentum;
  problem.mass.multiply(velocity, momentum);
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    Eigen::Vector3d at = Eigen::Vector3d::Zero(), own = Eigen::Vector3d::Zero();
    at.head(problem.dimension) = place.segment(node * problem.dimension, problem.dimension);
    own.head(problem.dimension) = momentum.segment(node * problem.dimension, problem.dimension);
    sum.head(3) += own;
    sum.tail(3) += at.cross(own);
  }
  if (problem.axisymmetric) sum[0] = sum[5] = 0.0;  // they cancel over the ring
  return sum;
}

TEST(VelocityCorrection, ChangesTheEnergyAndNeitherMomentaNorSupports) {
  const std::string left = "[[support]]\ngroup = \"left\"\ncomponents = [\"x\"]\n";
  for (const Kind& kind :
       {Kind{"plane", "strain", ""}, Kind{"held", "strain", left}, Kind{"ring", "axisymmetric", left},
        Kind{"space", "strain", ""}, Kind{"space", "strain", left}}) {
    for (const std::string mass : {"equivalent", "consistent"}) {
      const CaseRun run = run_of(kind, mass);
      const SemidiscreteProblem& problem = run.problem();
      const BodyRotations bodies(problem);
      VelocityCorrection correction(problem, bodies);
      srand(7);
      Vector velocity = Vector::Random(problem.dof_count()), displacement = 0.1 * Vector::Random(problem.dof_count());
      for (const Index dof : problem.supports.dofs()) velocity[dof] = displacement[dof] = 0.0;
      const Vector place = problem.nodes.reshaped() + displacement;
      const double energy = 0.5 * problem.mass.quadratic_form(velocity);
      correction.start(displacement);
      for (const double change : {1e-3 * energy, -1e-3 * energy, 1e-14 * energy}) {
        ASSERT_TRUE(correction.find(velocity, displacement, change)) << kind.name << mass;
        const Vector& added = correction.value();
        EXPECT_NEAR(0.5 * problem.mass.quadratic_form(velocity + added) - energy, change, 1e-15 * energy)
            << kind.name << mass;
        EXPECT_LT(momenta(problem, place, added).norm(), 1e-13 * added.norm()) << kind.name << mass;
        EXPECT_GT(added.norm(), 0.0);
        for (const Index dof : problem.supports.dofs()) EXPECT_EQ(added[dof], 0.0);
        for (const Index dof : problem.massless_dofs) EXPECT_EQ(added[dof], 0.0);
      }
      EXPECT_FALSE(correction.find(velocity, displacement, 2.0 * energy))
          << "much of what moves would be another motion";
    }
  }
}

/// Rigid motion has no energy that a correction without momentum could remove.
TEST(VelocityCorrection, TakesNothingOfRigidMotion) {
  const CaseRun run = run_of({"plane", "strain", ""}, "equivalent");
  const BodyRotations bodies(run.problem());
  VelocityCorrection correction(run.problem(), bodies);
  Vector velocity(run.problem().dof_count());
  for (Index node = 0; node < run.problem().nodes.cols(); ++node)
    velocity.segment<2>(2 * node) << 3.0 - 2.0 * run.problem().nodes(1, node), 2.0 * run.problem().nodes(0, node);
  const double energy = 0.5 * run.problem().mass.quadratic_form(velocity);
  const Vector undeformed = Vector::Zero(velocity.size());
  correction.start(undeformed);
  EXPECT_FALSE(correction.find(velocity, undeformed, -1e-9 * energy));
}

/// The force acts at the middle of the step, and the velocity at its end.
TEST(VelocityCorrection, GivesBodiesTheMomentaOfAResidual) {
  constexpr double step = 0.3;
  const std::string left = "[[support]]\ngroup = \"left\"\ncomponents = [\"x\"]\n";
  for (const Kind& kind : {Kind{"plane", "strain", ""}, Kind{"held", "strain", left},
                           Kind{"ring", "axisymmetric", left}, Kind{"space", "strain", ""}}) {
    for (const std::string mass : {"equivalent", "consistent"}) {
      const CaseRun run = run_of(kind, mass);
      const SemidiscreteProblem& problem = run.problem();
      const BodyRotations bodies(problem);
      VelocityCorrection correction(problem, bodies);
      srand(9);
      const Index count = problem.dof_count();
      const Vector end = 0.1 * Vector::Random(count), middle = 0.1 * Vector::Random(count);
      Vector residual = Vector::Random(count);
      for (const Index dof : problem.supports.dofs()) residual[dof] = 0.0;
      correction.start(end);
      Vector reaction = Vector::Zero(problem.supports.size());
      const Vector added = correction.of_momenta(residual, middle, step, reaction);
      // Moments are about the same point in space.
      Eigen::Matrix<double, 6, 1> expected = Eigen::Matrix<double, 6, 1>::Zero();
      for (Index node = 0; node < problem.nodes.cols(); ++node) {
        Eigen::Vector3d at = Eigen::Vector3d::Zero(), force = at;
        const Index d = problem.dimension;
        at.head(d) = problem.nodes.col(node) + middle.segment(node * d, d);
        force.head(d) = step * residual.segment(node * d, d);
        // Supports take over what the body cannot.
        for (Index i = 0; i < reaction.size(); ++i) {
          const Index dof = problem.supports.dofs()[std::size_t(i)];
          if (dof / d == node) force[dof % d] += step * reaction[i];
        }
        expected.head(3) += force;
        expected.tail(3) += at.cross(force);
      }
      if (problem.axisymmetric) expected[0] = expected[5] = 0.0;
      const auto found = momenta(problem, problem.nodes.reshaped() + end, added);
      EXPECT_LT((found - expected).norm(), 1e-13 * expected.norm()) << kind.name << mass;
      for (const Index dof : problem.supports.dofs()) EXPECT_EQ(added[dof], 0.0);
    }
  }
}

}  // namespace ricochet::test_support::velocity_correction_test
