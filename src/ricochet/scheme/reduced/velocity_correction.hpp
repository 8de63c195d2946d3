#pragma once

#include "ricochet/problem/body_rotations.hpp"

/// @file Correction that balances the energy of a step if no stress of its middle does (finite_strain_step.hpp).
namespace ricochet {

/// If cells at contact nodes are so much stiffer than their inertia in a step that they are in equilibrium throughout,
/// as in a step in which they begin to touch, their forces do the work that the motion of the others requires, for
/// every σ: displacements compensate σ p. Then α w is added to the velocities at the end, w their part that is no
/// motion of a body as a whole,
///   w = P (v₁ − Σ c_k r_k),   r_kᵀ M w = 0,
/// r_k the translations and rotations of each body about its positions at the end, P the projection on the dofs that
/// are neither supported nor without inertia. M α w / h is a force without resultant and moment: momenta stay exact,
/// and support reactions are unchanged. α, the smaller root of ½ α² wᵀMw + α v₁ᵀMw = −(energy defect), makes the
/// balance exact.
class VelocityCorrection {
 public:
  /// Keeps references.
  VelocityCorrection(const SemidiscreteProblem& problem, const BodyRotations& bodies)
      : problem_(problem), bodies_(bodies) {}

  /// Computes the correction at this velocity and displacement at the end for a given change of the kinetic energy, in
  /// J. Returns false if that takes more than half of w.
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
  Points positions_;  ///< positions relative to the centre of the node's body
  Vector value_, momentum_, mode_;
};

}  // namespace ricochet
