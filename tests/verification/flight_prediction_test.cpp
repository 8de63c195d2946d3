#include "ricochet/problem/flight_prediction.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Predicted positions of bodies in free flight.
namespace ricochet::test_support::flight_prediction_test {

/// Nodal values v̄ + ω × (x − X̄).
Vector values_at_nodes(const SemidiscreteProblem& problem, const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin,
                       const Eigen::Vector3d& centre) {
  Vector result(problem.dof_count());
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    place.head(problem.dimension) = problem.nodes.col(node);
    result.segment(node * problem.dimension, problem.dimension) =
        (velocity + spin.cross(place - centre)).head(problem.dimension);
  }
  return result;
}

Eigen::Vector3d centre_of_mass(const SemidiscreteProblem& problem) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Vector moment;
  for (int k = 0; k < problem.dimension; ++k) {
    const Vector along = values_at_nodes(problem, Eigen::Vector3d::Unit(k), Eigen::Vector3d::Zero(), centre);
    problem.mass.multiply(along, moment);
    centre[k] = moment.dot(problem.nodes.reshaped()) / moment.dot(along);
  }
  return centre;
}

TEST(FlightPrediction, TurnsRigidBodiesAsTheMidpointRule) {
  for (const std::string mass : {"equivalent", "consistent"}) {
    for (const ThrownBody& body : thrown_bodies()) {
      if (!body.against.empty()) continue;  // two bodies, each with its own centre
      CaseRun run(thrown_case(body, mass, "scheme = \"newmark\"\npreset = \"trapezoidal\"\n"),
                  {"material.0.law=neo-hookean"});
      const SemidiscreteProblem& problem = run.problem();
      FlightPrediction flight(problem);
      const Eigen::Vector3d centre = centre_of_mass(problem);
      const Eigen::Vector3d velocity =
          problem.dimension == 2 ? Eigen::Vector3d(3.0, -2.0, 0.0) : Eigen::Vector3d(3.0, -2.0, 1.0);
      const Eigen::Vector3d spin =
          problem.dimension == 2 ? Eigen::Vector3d(0.0, 0.0, 7.0) : Eigen::Vector3d(4.0, -5.0, 7.0);
      const double step = 0.1;
      Vector end;
      flight.predict(Vector::Zero(problem.dof_count()), values_at_nodes(problem, velocity, spin, centre), step, end);
      // tan(φ/2) = h|ω|/2.
      const Eigen::AngleAxisd turn(2.0 * std::atan(0.5 * step * spin.norm()), spin.normalized());
      Vector expected(end.size());
      for (Index node = 0; node < problem.nodes.cols(); ++node) {
        Eigen::Vector3d arm = -centre;
        arm.head(problem.dimension) += problem.nodes.col(node);
        expected.segment(node * problem.dimension, problem.dimension) =
            (turn * arm - arm + step * velocity).head(problem.dimension);
      }
      EXPECT_LT((end - expected).lpNorm<Eigen::Infinity>(), 1e-12) << body.name << mass;
    }
  }
}

}  // namespace ricochet::test_support::flight_prediction_test
