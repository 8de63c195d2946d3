#pragma once

#include "ricochet/fem/elastic_cells.hpp"
#include "ricochet/problem/internal_force.hpp"

/// @file Stress that relaxes (fem/relaxation.hpp), beside the internal force of the material laws. Its internal strains
/// A are part of the state; their length is internal_size().
namespace ricochet {

class ViscousForce {
 public:
  virtual ~ViscousForce() = default;
  [[nodiscard]] virtual Index internal_size() const = 0;
  /// The A at which nothing has stress: of a body that has been at this displacement for long.
  virtual void relax(const Vector& displacement, Vector& internal) const = 0;
  /// Stored energy at an instant.
  [[nodiscard]] virtual double branch_energy(const Vector& displacement, const Vector& internal) const = 0;

  // Forces, added to those of the laws:
  /// What acts over a step, at its middle. Where that is ½(u₀+u₁) its work on the increment is the change of the
  /// stored energy and what advance_internal() says.
  virtual void add_mean_force(const BranchStep& step, Vector& force) const = 0;
  /// At the end of the step, with A₁.
  virtual void add_end_force(const BranchStep& step, Vector& force) const = 0;
  /// Of a potential at a displacement, which says what contact nodes lose that jump at the start of a step
  /// (RelaxationRule::start_energy(), scheme/reduced/finite_layer.hpp).
  virtual void add_start_force(const BranchStep& step, const Vector& displacement, Vector& force) const = 0;
  [[nodiscard]] virtual double start_energy(const BranchStep& step, const Vector& displacement) const = 0;
  /// Of the laws and of this, over a step of a length; see InternalForce::tangent().
  [[nodiscard]] virtual SparseMatrix step_tangent(const Vector& displacement, double step) const = 0;
  /// A₁; returns the energy that the step dissipates, never negative.
  [[nodiscard]] virtual double advance_internal(const BranchStep& step, Vector& internal) const = 0;
};

/// Of the laws and of what relaxes beside them. `internal`: of the state; not looked at where nothing relaxes.
[[nodiscard]] inline double stored_energy(const InternalForce& force, const Vector& displacement,
                                          const Vector& internal) {
  const ViscousForce* const viscous = force.viscous();
  return force.energy(displacement) + (viscous != nullptr ? viscous->branch_energy(displacement, internal) : 0.0);
}

}  // namespace ricochet
