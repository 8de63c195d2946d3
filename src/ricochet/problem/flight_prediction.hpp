#pragma once

#include <vector>

#include "ricochet/problem/body_rotations.hpp"

/// @file Where bodies will be after a step, for a first guess of places that hardly strains those that spin: going
/// straight on strains a body by half of the square of the angle.
namespace ricochet {

/// Each body goes on as it moves now: with the centre c of its mass, the velocity v̄ of that, the spin ω that has its
/// angular momentum, r = x − c and v = v̄ + ω × r + w, it is at c + h v̄ + R (r + h w), with R about ω by the angle
/// 2 arctan(h|ω|/2) by which the midpoint rule turns. Bodies that do not turn (body_rotations.hpp) go straight on.
/// Contact nodes without inertia have w = 0: their velocity is the mean of a step. A body that spins rigidly about a
/// principal axis is where the midpoint rule takes it.
class FlightPrediction {
 public:
  /// After a mass and supports are known. Keeps a reference.
  explicit FlightPrediction(const SemidiscreteProblem& problem);
  /// Displacements after a step; `end` keeps its storage.
  void predict(const Vector& displacement, const Vector& velocity, double step, Vector& end);
  [[nodiscard]] const BodyRotations& bodies() const { return bodies_; }

 private:
  /// Of a body as a whole, three coordinates each.
  struct Flight {
    double mass = 0.0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
    Tensor spread = Tensor::Zero();  ///< Σ r ⊗ M r
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), spin = Eigen::Vector3d::Zero();
    Tensor rotation = Tensor::Identity();
  };
  void fit(const Vector& displacement, const Vector& velocity, double step);
  template <class Visit>
  void visit_nodes(const Visit& visit) const;
  [[nodiscard]] bool has_inertia(Index node) const;
  [[nodiscard]] Eigen::Vector3d at(const Vector& values, Index node) const;

  const SemidiscreteProblem& problem_;
  BodyRotations bodies_;
  Vector node_mass_;
  std::vector<Flight> flights_;
  Vector place_, first_moment_, momentum_;  ///< x, M x, M v
};

}  // namespace ricochet
