#pragma once

#include <tuple>

#include "ricochet/base/types.hpp"

/// @file Properties and motion of a body as a rigid body.
namespace ricochet {

/// Reference configuration; in the plane z = 0, and per unit of thickness. An axisymmetric body is the whole solid: its
/// centre is on the axis, and its inertia is that in space.
struct RigidBody {
  double mass = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre; in the plane only its zz entry is used
  bool held = false;                                  ///< supports at rest leave it no rigid motion
};

/// Mean motion of a body and its energies.
struct RigidMotionState {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< momentum / mass; if axisymmetric, that along the axis
  /// Angular momentum about the centre of mass, solved with the inertia about it; reference positions, at finite strain
  /// current ones.
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();
  double kinetic_energy = 0.0;        ///< of the whole motion, ½VᵀMV
  double rigid_kinetic_energy = 0.0;  ///< of velocity and spin alone; the remainder is that of vibrations

  [[nodiscard]] auto members() { return std::tie(velocity, spin, kinetic_energy, rigid_kinetic_energy); }
};

}  // namespace ricochet
