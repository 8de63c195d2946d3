#pragma once

#include <optional>

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"
#include "ricochet/problem/internal_force.hpp"

/// @file Viscous damping of Rayleigh's form, C = Σ (α M + η K) over the materials.
namespace ricochet {

/// The force C V of the two parts of C. Stress rates do not see a rigid motion, but rounding does: η K V of a stiff
/// body that flies has an error of 10⁻¹⁶ η |K| |V|, whose work can create more energy than the damping takes away. So
/// the stiffness part acts on V less its rigid part, as LinearElasticity's does on U.
class Damping {
 public:
  /// Each matrix dofs × dofs, symmetric to the bit; `nodes`: reference positions, d × count.
  void set_mass_part(const SparseMatrix& matrix, const Points& nodes);
  void set_stiffness_part(const SparseMatrix& matrix, const Points& nodes);

  /// Dampers to the ground, c_i V_i: per dof.
  void set_ground_part(const Vector& coefficients) { ground_ = coefficients; }

  [[nodiscard]] bool is_absent() const { return !mass_part_ && !stiffness_part_ && ground_.size() == 0; }
  [[nodiscard]] const NodeMatrix* mass_part() const { return mass_part_ ? &*mass_part_ : nullptr; }
  [[nodiscard]] bool has_stiffness_part() const { return stiffness_part_.has_value(); }
  [[nodiscard]] const NodeMatrix* stiffness_part() const {
    return stiffness_part_ ? stiffness_part_->constant_tangent() : nullptr;
  }
  [[nodiscard]] const Vector& ground_part() const { return ground_; }  ///< empty: none
  /// `force` = C `velocity`; two vectors. Needs a part.
  void evaluate(const Vector& velocity, Vector& force) const;
  /// C, dofs × dofs, made anew by every call. Needs a part.
  [[nodiscard]] SparseMatrix matrix() const;

 private:
  std::optional<NodeMatrix> mass_part_;
  std::optional<LinearElasticity> stiffness_part_;
  Vector ground_;  ///< empty: none
  mutable Vector part_;
};

}  // namespace ricochet
