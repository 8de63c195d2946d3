#pragma once

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"
#include "ricochet/problem/rigid_motion.hpp"

/// @file The body's elastic response: internal force, tangent and energy behind one small interface. Linear elasticity
/// has a constant tangent; a law of finite strain would not.
namespace ricochet {

class InternalForce {
 public:
  virtual ~InternalForce() = default;
  /// Nodal forces of the stress at displacement U (for linear elasticity K U).
  virtual void evaluate(const Vector& displacement, Vector& force) const = 0;
  /// Strain energy (½UᵀKU).
  [[nodiscard]] virtual double energy(const Vector& displacement) const = 0;
  /// ∂force/∂U, symmetric. Made anew by every call, which takes the time of some tens of evaluations: ask once, and do
  /// not keep it longer than needed.
  [[nodiscard]] virtual SparseMatrix tangent() const = 0;
};

/// K U, computed from U less its rigid motion, which has no part in it.
class LinearElasticity final : public InternalForce {
 public:
  /// K symmetric to the bit, dofs × dofs; `nodes`: reference positions, d × count.
  LinearElasticity(const SparseMatrix& stiffness, const Points& nodes);
  void evaluate(const Vector& displacement, Vector& force) const override;
  [[nodiscard]] double energy(const Vector& displacement) const override;
  [[nodiscard]] SparseMatrix tangent() const override { return stiffness_.whole(); }

 private:
  RigidMotion rigid_;
  NodeMatrix stiffness_;
  mutable Vector deformation_;
};

}  // namespace ricochet
