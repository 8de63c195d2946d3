#pragma once

#include <optional>

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"
#include "ricochet/problem/internal_force.hpp"

/// @file Rayleigh damping, C = Σ (α M + η K) over the materials.
namespace ricochet {

/// Viscous force C V of the two parts of C. In exact arithmetic a rigid motion causes no stress rate, but in floating
/// point η K V of a stiff body in flight has an error of 10⁻¹⁶ η |K| |V|, whose work may exceed the energy that damping
/// dissipates. The stiffness part therefore acts on V minus its rigid part, as LinearElasticity's does on U.
class Damping {
 public:
  /// Sets one part: matrix dofs × dofs, exactly symmetric; `nodes`: reference positions, d × count.
  void set_mass_part(const SparseMatrix& matrix, const Points& nodes);
  void set_stiffness_part(const SparseMatrix& matrix, const Points& nodes);

  /// Sets dampers to the ground, with forces c_i V_i: one coefficient per dof.
  void set_ground_part(const Vector& coefficients) { ground_ = coefficients; }

  [[nodiscard]] bool is_absent() const { return !mass_part_ && !stiffness_part_ && ground_.size() == 0; }
  [[nodiscard]] const NodeMatrix* mass_part() const { return mass_part_ ? &*mass_part_ : nullptr; }
  [[nodiscard]] bool has_stiffness_part() const { return stiffness_part_.has_value(); }
  [[nodiscard]] const NodeMatrix* stiffness_part() const {
    return stiffness_part_ ? stiffness_part_->constant_tangent() : nullptr;
  }
  [[nodiscard]] const Vector& ground_part() const { return ground_; }  ///< empty if none
  /// Computes `force` = C `velocity`; the two must not alias. Requires a part.
  void evaluate(const Vector& velocity, Vector& force) const;
  /// Assembles C, dofs × dofs, anew in every call. Requires a part.
  [[nodiscard]] SparseMatrix matrix() const;

 private:
  std::optional<NodeMatrix> mass_part_;
  std::optional<LinearElasticity> stiffness_part_;
  Vector ground_;  ///< empty if none
  mutable Vector part_;
};

}  // namespace ricochet
