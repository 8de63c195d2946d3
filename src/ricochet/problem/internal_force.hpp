#pragma once

#include "ricochet/base/types.hpp"

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

class LinearElasticity final : public InternalForce {
 public:
  explicit LinearElasticity(SparseMatrix stiffness) : stiffness_(std::move(stiffness)) {}
  void evaluate(const Vector& displacement, Vector& force) const override {
    force.noalias() = stiffness_ * displacement;
  }
  [[nodiscard]] double energy(const Vector& displacement) const override;
  [[nodiscard]] const SparseMatrix& tangent() const override { return stiffness_; }

 private:
  SparseMatrix stiffness_;
  mutable Vector work_;
};

}  // namespace ricochet
