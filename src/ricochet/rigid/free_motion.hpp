#pragma once

#include "ricochet/base/snapshot.hpp"
#include "ricochet/rigid/pose.hpp"

/// @file Rigid bodies that move freely under the forces on them.
namespace ricochet {

/// A rigid body has two nodes among those of the problem, at its centre of mass and without cells. The displacement of
/// the first is that of the centre. The displacement of the second is ℓ_k Θ_k, with Θ the rotation accumulated step by
/// step about its principal axes, and ℓ_k = √(J_k/m) its radii of gyration: with the mass m on either node the kinetic
/// energy is ½VᵀMV. In the plane its second component is always zero.
///
/// Over a step from the rotation A₀ (of principal axes) to A₁ = A₀ cay(Θ), cay(Θ) = (1 − ½Θ^)⁻¹(1 + ½Θ^), a point of
/// the body moves by exactly Δc + θ × a, with θ = A₀Θ and a the mean of its arms about the centre at both ends. With
/// the spin W about the axes, Θ = ½h(W₀ + W₁), and a torque τ = A₀τ₀ of the step in space,
///   A₁JW₁ − A₀JW₀ = hτ,   ½W₁ᵀJW₁ − ½W₀ᵀJW₀ = θ·τ
/// hold together, to rounding (J. C. Simo, K. K. Wong, Int. J. Numer. Methods Engng. 31 (1991) 19–52), if
///   (2/h²) J(Θ − hW₀) = τ₀ − g(Θ, W₀),
/// with g the gyroscopic torque (add_gyroscopic_force), which vanishes in the plane.
class FreeMotion {
 public:
  struct Inertia {
    double mass = 0.0;
    SpaceVector centre;        ///< centre of mass, in the frame of the obstacle's description
    SpaceVector moments;       ///< J_k about the centre: 1 in the plane, 3 in space
    Pose::Rotation principal;  ///< principal axes as columns, in space; empty: the coordinate axes
  };
  /// `node`: the first of its two nodes.
  FreeMotion(Inertia inertia, Index node);

  [[nodiscard]] const Inertia& inertia() const { return inertia_; }
  [[nodiscard]] Index centre_node() const { return node_; }
  [[nodiscard]] Index rotation_node() const { return node_ + 1; }
  [[nodiscard]] Index dimension() const { return inertia_.centre.size(); }
  /// Radii of gyration ℓ.
  [[nodiscard]] const SpaceVector& gyration() const { return gyration_; }

  /// Begins a step at this displacement, to which the functions below refer.
  void begin_step(const Vector& displacement);
  void persist(const SnapshotVisitor& visit);

  /// Pose at a displacement of the step.
  [[nodiscard]] Pose pose(const Vector& displacement) const;
  [[nodiscard]] SpaceVector centre(const Vector& displacement) const;
  /// Rotation A of the principal axes at a displacement, and A₀ at the start of the step.
  [[nodiscard]] Pose::Rotation axes(const Vector& displacement) const;
  [[nodiscard]] const Pose::Rotation& axes_at_start() const { return axes_; }
  /// Writes the derivative of n·(position of the body's point) with respect to the displacements of its nodes: 2d
  /// numbers; `arm` is about the centre, `axes` are those to which θ refers.
  void write_row(const SpaceVector& direction, const SpaceVector& arm, const Pose::Rotation& axes, double* row) const;
  /// Torque about the centre from forces on its second node (about A₀): a vector in space, one component in the plane.
  [[nodiscard]] SpaceVector torque(const Vector& force) const;
  /// Torque about the centre of a force on its first node that acts at an arm from there, in the same components.
  [[nodiscard]] SpaceVector torque(const SpaceVector& arm, const Vector& force) const;
  /// Adds a torque in space to the forces of a step.
  void add_torque(const SpaceVector& torque, Vector& force) const;
  /// Angular momentum about the centre at a displacement with this velocity, in the same components.
  [[nodiscard]] SpaceVector angular_momentum(const Vector& displacement, const Vector& velocity) const;
  /// Velocity V of the second node for an angular momentum about the centre, in the same components, at a displacement.
  [[nodiscard]] SpaceVector velocity_of_momentum(const SpaceVector& momentum, const Vector& displacement) const;
  /// Angular velocity in space.
  [[nodiscard]] SpaceVector angular_velocity(const Vector& displacement, const Vector& velocity) const;
  /// Velocity V of the second node for an angular velocity in space, at a displacement.
  [[nodiscard]] SpaceVector rotational_velocity(const SpaceVector& spin, const Vector& displacement) const;

  /// Adds −g/ℓ for a step of length h that starts with `velocity` and ends at the displacement `end`.
  void add_gyroscopic_force(const Vector& end, const Vector& velocity, double step, Vector& force) const;
  [[nodiscard]] bool has_gyroscopic_force() const { return dimension() == 3; }

 private:
  [[nodiscard]] SpaceVector step_rotation(const Vector& displacement) const;

  Inertia inertia_;
  Index node_;
  SpaceVector gyration_;
  Pose::Rotation axes_;            ///< A₀
  SpaceVector rotation_at_start_;  ///< the second node's displacement at the start of the step
};

/// Cayley transform cay(Θ); in the plane Θ has one component.
[[nodiscard]] Pose::Rotation cayley(const SpaceVector& rotation);

}  // namespace ricochet
