#pragma once

#include "ricochet/fem/elastic_cells.hpp"
#include "ricochet/problem/internal_force.hpp"

/// @file Stress of viscoelastic branches (fem/relaxation.hpp), in addition to the internal force of the material laws.
/// Their internal strains A are part of the state; internal_size() is their length.
namespace ricochet {

class ViscousForce {
 public:
  virtual ~ViscousForce() = default;
  [[nodiscard]] virtual Index internal_size() const = 0;
  /// Computes the A at which the branches are free of stress: a body at this displacement after complete relaxation.
  virtual void relax(const Vector& displacement, Vector& internal) const = 0;
  /// Energy stored in the branches at an instant.
  [[nodiscard]] virtual double branch_energy(const Vector& displacement, const Vector& internal) const = 0;

  // Forces, added to those of the material laws:
  /// Adds the force over a step, evaluated at its middle. If that is ½(u₀+u₁), its work on the increment equals the
  /// change of the stored energy plus the dissipation that advance_internal() returns.
  virtual void add_mean_force(const BranchStep& step, Vector& force) const = 0;
  /// Adds the force at the end of the step, with A₁.
  virtual void add_end_force(const BranchStep& step, Vector& force) const = 0;
  /// Potential at a displacement, which measures the energy lost by contact nodes that jump at the start of a step
  /// (RelaxationRule::start_energy(), scheme/reduced/finite_strain_step.hpp).
  [[nodiscard]] virtual double start_energy(const BranchStep& step, const Vector& displacement) const = 0;
  /// Tangent of the laws and the branches over a step of the given length; see InternalForce::tangent().
  [[nodiscard]] virtual SparseMatrix step_tangent(const Vector& displacement, double step) const = 0;
  /// Returns the derivative of the path force of the laws and the mean force of the branches over a step; see
  /// InternalForce::path_tangent(). The end of the step is x + ½ Δ̂.
  [[nodiscard]] virtual SparseMatrix step_path_tangent(const BranchStep& step, const PathRules& rules,
                                                       const PathVariation& variation) const = 0;
  /// Computes A₁; returns the energy that the step dissipates, never negative.
  [[nodiscard]] virtual double advance_internal(const BranchStep& step, Vector& internal) const = 0;
};

/// Stored energy of the laws and of the viscoelastic branches. `internal`: A of the state; unused without branches.
[[nodiscard]] inline double stored_energy(const InternalForce& force, const Vector& displacement,
                                          const Vector& internal) {
  const ViscousForce* const viscous = force.viscous();
  return force.energy(displacement) + (viscous != nullptr ? viscous->branch_energy(displacement, internal) : 0.0);
}

}  // namespace ricochet
