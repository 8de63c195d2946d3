#pragma once

#include <vector>

#include "ricochet/fem/material_law.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file How far each body has turned.
namespace ricochet {

/// The rotation R of a body is that which fits its places x best in the sense of least squares,
/// Σ |x_a − x̄ − R (X_a − X̄)|² over nodes: the orthogonal part of Σ (x_a − x̄)(X_a − X̄)ᵀ. Bodies that supports hold do
/// not turn as a whole, and have R = I; where these hold one component in space alone, as on a plane of symmetry, a
/// body turns about that axis. Axisymmetric bodies do not turn.
class BodyRotations {
 public:
  /// Bodies are the connected components of the graph of K. Keeps a reference.
  explicit BodyRotations(const SemidiscreteProblem& problem);

  [[nodiscard]] std::size_t count() const { return bodies_.size(); }
  /// −1 for nodes that follow others.
  [[nodiscard]] int body_of_node(Index node) const { return body_of_node_[static_cast<std::size_t>(node)]; }
  /// One per body; in the plane they turn about z.
  void fit(const Vector& displacement, std::vector<Tensor>& rotations) const;
  /// Displacements after a step of free flight in which strains change as they do now: with r = x − x̄ and the spin ω
  /// that fits velocities best, v = v̄ + ω × r + w, a body is at x̄ + h v̄ + R (r + h w), with R about ω by the angle
  /// 2 arctan(h|ω|/2) by which the midpoint rule turns. Bodies that do not turn go straight on. Contact nodes, whose
  /// velocity may be the mean of a step (they have no inertia), have no part in v̄ and ω, and w = 0. Keeps the storage
  /// of `end`.
  void predict(const Vector& displacement, const Vector& velocity, double step, Vector& end) const;

 private:
  /// The rotation is a frame to solve in and no result: a sample of nodes has it near enough.
  static constexpr Index most_fitted = 1024;
  struct Body {
    std::vector<Index> members;
    std::vector<Index> fitted;  ///< some of these; none: it does not turn
    int axis = -1;              ///< that it turns about; −1: any
  };
  /// The motion of a body as a whole, three coordinates each.
  struct Flight {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero(),
                    spin = Eigen::Vector3d::Zero();
  };
  template <int d>
  [[nodiscard]] Tensor fit_body(const Body& body, const Vector& displacement) const;
  [[nodiscard]] Flight fit_flight(const Body& body, const Vector& displacement, const Vector& velocity) const;
  [[nodiscard]] Eigen::Vector3d place(Index node, const Vector& displacement) const;

  const SemidiscreteProblem& problem_;
  std::vector<Body> bodies_;
  std::vector<int> body_of_node_;
  std::vector<char> is_contact_;
};

/// The angle of a rotation, in [0, π].
[[nodiscard]] double rotation_angle(const Tensor& rotation);

}  // namespace ricochet
