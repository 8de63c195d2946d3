#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/simulation/impact/rigid_body.hpp"

/// @file Rigid-body quantities of the bodies of a mesh: mass, centre, inertia and mean motion from their mass matrix.
/// The free rigid bodies follow them.
namespace ricochet {

class RigidBodies {
 public:
  /// `body_of_node`: numbers from 0, below `count`. Keeps a reference to the problem.
  RigidBodies(const SemidiscreteProblem& problem, std::vector<int> body_of_node, int count);

  [[nodiscard]] const std::vector<RigidBody>& bodies() const { return bodies_; }
  [[nodiscard]] int body_of_node(Index node) const { return body_of_node_[std::size_t(node)]; }
  /// Motion of all bodies with this velocity at this displacement. Costs one product with M and one pass; allocates
  /// nothing after the first time. The reference stays valid until the next call.
  /// Spins of the mesh's bodies are about reference positions, at finite strain about current ones.
  [[nodiscard]] const std::vector<RigidMotionState>& motion(const Vector& velocity, const Vector& displacement);

 private:
  [[nodiscard]] Eigen::Vector3d arm(Index node) const;
  void sum_over_ranks(std::vector<Eigen::Vector3d>& values) const;
  void find_supported_bodies();
  void add_free_bodies();
  void measure();
  void measure_at(const Vector& displacement);
  void measure_axisymmetric();

  const SemidiscreteProblem& problem_;
  std::vector<int> body_of_node_;
  std::vector<Eigen::Vector3d> origin_;  ///< mean of the body's nodes, about which sums are taken to limit rounding
  std::vector<RigidBody> bodies_;
  std::vector<RigidMotionState> motion_;
  Vector momentum_;
  // At a displacement:
  Vector position_, weighted_;  ///< x, M x
  std::vector<Eigen::Vector3d> centre_;
  std::vector<Eigen::Matrix3d> inertia_;
};

}  // namespace ricochet
