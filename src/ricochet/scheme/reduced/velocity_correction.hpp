#pragma once

#include "ricochet/problem/body_rotations.hpp"

/// @file What is left to balance the energy of a step where no stress of its middle does (finite_layer.hpp).
namespace ricochet {

/// Where cells at contact nodes are so much stiffer than their inertia in a step that they are in equilibrium through
/// it, as in one in which they begin to touch, their forces have the work that the motion of the others asks for,
/// whatever σ is: σ p is taken back by the places. Then the velocities at the end get α w, w the part of them that is
/// no motion of a body as a whole,
///   w = P (v₁ − Σ c_k r_k),   r_kᵀ M w = 0,
/// r_k the translations and rotations of each body about its places at the end, P the dofs that are neither supported
/// nor without inertia. M α w / h is a force without resultant and moment: momenta stay exact, supports hold what they
/// held. α, the smaller root of ½ α² wᵀMw + α v₁ᵀMw = −(what the balance lacks), makes the balance exact.
class VelocityCorrection {
 public:
  /// Keeps references.
  VelocityCorrection(const SemidiscreteProblem& problem, const BodyRotations& bodies)
      : problem_(problem), bodies_(bodies) {}

  /// Of the velocity and displacement at the end, for what the kinetic energy is to change by, J. False where that
  /// takes more than half of w.
  [[nodiscard]] bool find(const Vector& velocity, const Vector& displacement, double change);
  /// α w.
  [[nodiscard]] const Vector& value() const { return value_; }

 private:
  static constexpr double largest_part = 0.5;

  [[nodiscard]] int mode_count() const;
  void set_mode(int mode, Vector& values) const;
  void mask(Vector& values) const;
  void find_relative(const Vector& velocity, const Vector& displacement);

  const SemidiscreteProblem& problem_;
  const BodyRotations& bodies_;
  Points places_;  ///< from the centre of a node's body
  Vector value_, momentum_, mode_;
};

}  // namespace ricochet
