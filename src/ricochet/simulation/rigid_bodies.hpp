#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The bodies of a mesh as rigid bodies: what their mass matrix says of mass, centre, inertia and mean motion.
namespace ricochet {

/// Reference configuration; in the plane z = 0, and per unit of thickness.
struct RigidBody {
  double mass = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre; in the plane only its zz entry is used
};

/// Mean motion of a body and its energies.
struct RigidMotionState {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the centre of mass: momentum / mass
  /// Angular momentum about the centre of mass, solved with the inertia about it; reference positions.
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();
  double kinetic_energy = 0.0;        ///< of the whole motion, ½VᵀMV
  double rigid_kinetic_energy = 0.0;  ///< of velocity and spin alone; the rest is that of vibrations
};

class RigidBodies {
 public:
  /// `body_of_node`: numbers from 0, below `count`. Keeps a reference to the problem.
  RigidBodies(const SemidiscreteProblem& problem, std::vector<int> body_of_node, int count);

  [[nodiscard]] const std::vector<RigidBody>& bodies() const { return bodies_; }
  [[nodiscard]] int body_of_node(Index node) const { return body_of_node_[static_cast<std::size_t>(node)]; }
  /// Of all bodies with this velocity. One product with M and one pass; allocates nothing after the first time. The
  /// reference stays valid until the next call.
  [[nodiscard]] const std::vector<RigidMotionState>& motion(const Vector& velocity);

 private:
  [[nodiscard]] Eigen::Vector3d arm(Index node) const;
  void measure();

  const SemidiscreteProblem& problem_;
  std::vector<int> body_of_node_;
  std::vector<Eigen::Vector3d> origin_;  ///< mean of the body's nodes: what sums are taken about, for their rounding
  std::vector<RigidBody> bodies_;
  std::vector<RigidMotionState> motion_;
  Vector momentum_;
};

}  // namespace ricochet
