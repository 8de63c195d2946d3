#pragma once

#include <Eigen/Geometry>

#include "ricochet/problem/viscous_force.hpp"
#include "support/case_run.hpp"

/// @file Momenta and energy of a motion, computed from the mass and the state alone.
namespace ricochet::test_support {

/// Momenta about the origin and at current positions.
struct Momenta {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  explicit Momenta(const CaseRun& run) {
    const SemidiscreteProblem& problem = run.problem();
    const Index d = problem.dimension;
    Vector momentum;
    problem.mass.multiply(run.state().velocity, momentum);
    for (Index node = 0; node < problem.nodes.cols(); ++node) {
      Eigen::Vector3d place = Eigen::Vector3d::Zero(), own = Eigen::Vector3d::Zero();
      place.head(d) = problem.nodes.col(node) + run.state().displacement.segment(node * d, d);
      own.head(d) = momentum.segment(node * d, d);
      linear += own;
      angular += place.cross(own);
    }
  }
};

/// Returns the kinetic and stored energy, less the work of constant loads.
[[nodiscard]] inline double energy_of(const CaseRun& run) {
  const State& state = run.state();
  return 0.5 * run.problem().mass.quadratic_form(state.velocity) +
         stored_energy(*run.problem().internal_force, state.displacement, state.internal_strain) -
         run.problem().loads.constant().dot(state.displacement);
}

}  // namespace ricochet::test_support
