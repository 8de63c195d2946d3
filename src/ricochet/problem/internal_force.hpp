#pragma once

#include "ricochet/base/types.hpp"
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
  /// ∂force/∂U, symmetric.
  [[nodiscard]] virtual const SparseMatrix& tangent() const = 0;
};

/// K U, computed from U less its rigid motion, which has no part in it.
class LinearElasticity final : public InternalForce {
 public:
  /// `nodes`: reference positions, d × count.
  LinearElasticity(SparseMatrix stiffness, const Points& nodes)
      : stiffness_(std::move(stiffness)), rigid_(nodes, stiffness_) {}
  void evaluate(const Vector& displacement, Vector& force) const override;
  [[nodiscard]] double energy(const Vector& displacement) const override;
  [[nodiscard]] const SparseMatrix& tangent() const override { return stiffness_; }

 private:
  SparseMatrix stiffness_;
  RigidMotion rigid_;
  mutable Vector deformation_, work_;
};

}  // namespace ricochet
