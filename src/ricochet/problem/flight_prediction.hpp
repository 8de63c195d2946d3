#pragma once

#include <vector>

#include "ricochet/problem/body_rotations.hpp"

/// @file Prediction of the positions after a step, an initial guess that hardly strains spinning bodies: a straight
/// extrapolation strains a body by half the square of the angle of rotation.
namespace ricochet {

/// Each body continues its present motion: with its centre of mass c, the velocity v̄ of c, the spin ω that has the
/// angular momentum of the body, r = x − c and v = v̄ + ω × r + w, a node moves to c + h v̄ + R (r + h w), with R
/// the rotation about ω by 2 arctan(h|ω|/2), the angle of the midpoint rule. Bodies that do not rotate
/// (body_rotations.hpp) are extrapolated along straight lines. Contact nodes without inertia have w = 0, since
/// their velocity is the mean over a step. For a body in rigid spin about a principal axis the prediction is
/// exactly the result of the midpoint rule.
class FlightPrediction {
 public:
  /// Requires a problem with mass and supports. Keeps a reference.
  explicit FlightPrediction(const SemidiscreteProblem& problem);
  /// Predicts the displacement after a step; `end` keeps its storage.
  void predict(const Vector& displacement, const Vector& velocity, double step, Vector& end);
  [[nodiscard]] const BodyRotations& bodies() const { return bodies_; }

 private:
  /// Motion of a body as a whole; vectors have three components.
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
  Vector positions_, first_moment_, momentum_;  ///< x, M x, M v
};

}  // namespace ricochet
