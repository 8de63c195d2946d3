#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/matrix_graph.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"
#include "ricochet/problem/rigid_motion.hpp"

/// @file The body's elastic response: internal force, tangent and energy behind one small interface. Linear elasticity
/// has a constant tangent; laws of finite strain have not (finite_elasticity.hpp).
namespace ricochet {

class ViscousForce;

class InternalForce {
 public:
  virtual ~InternalForce() = default;
  /// Nodal forces of the stress at displacement U (for linear elasticity K U). Throws Error(not_converged) that names
  /// the cell where the displacement turns one inside out.
  virtual void evaluate(const Vector& displacement, Vector& force) const = 0;
  /// Strain energy (½UᵀKU).
  [[nodiscard]] virtual double energy(const Vector& displacement) const = 0;
  /// Forces at a displacement of the stress 𝔻₀ : (the derivative of the strain along `increment`), with the tangent 𝔻₀
  /// at zero strain (for linear elasticity K times the increment): forces that no rotation changes, without resultant
  /// or moment about the current positions.
  virtual void strain_force(const Vector& displacement, const Vector& increment, Vector& force) const = 0;
  /// The same where the force that evaluate() gives for this displacement is known.
  [[nodiscard]] virtual double energy(const Vector& displacement, const Vector& force) const;
  /// Forces of a step from u₀ to u₁ = u₀ + increment at a displacement in its middle: of the stress of ½(E₀+E₁) where
  /// that is ½(u₀+u₁), so that a rigid motion has none. Only where the force is not linear; throws as evaluate() does.
  virtual void mean_force(const Vector& middle, const Vector& increment, Vector& force) const;
  /// That with strain_force() at the same place, for less than both take alone.
  virtual void mean_forces(const Vector& middle, const Vector& increment, Vector& force, Vector& of_strain) const;
  /// The part of it that is of the cells at some nodes (per node, 1: wanted): their forces, and the energy of these
  /// cells alone. Only where the force is not linear.
  [[nodiscard]] virtual std::shared_ptr<const InternalForce> near(const std::vector<char>& nodes) const;
  /// Adds what of it acts from the ground, no stress: the force of springs at a displacement, as evaluate() has it.
  virtual void add_ground_force(const Vector& /*displacement*/, Vector& /*force*/) const {}
  /// What relaxes beside it (viscous_force.hpp), which is in nothing here; null where nothing does.
  [[nodiscard]] virtual const ViscousForce* viscous() const { return nullptr; }
  /// The force is a linear function of U: the tangent is the same everywhere. Who relies on that asks (require_linear).
  [[nodiscard]] virtual bool is_linear() const = 0;
  /// ∂force/∂U at a displacement (empty: the undeformed body), symmetric, of one pattern. Made anew by every call,
  /// which takes the time of some tens of evaluations: ask once, and do not keep it longer than needed.
  [[nodiscard]] virtual SparseMatrix tangent(const Vector& displacement) const = 0;
  [[nodiscard]] SparseMatrix tangent() const { return tangent(Vector()); }
  /// The tangent, where it is the same everywhere and kept; else null.
  [[nodiscard]] virtual const NodeMatrix* constant_tangent() const { return nullptr; }
  /// Of the undeformed body: the diagonal of K, and the nodes that its entries join, d dofs each.
  [[nodiscard]] Vector stiffness_diagonal() const;
  [[nodiscard]] MatrixGraph graph(int d) const;
  /// Σ |u_i| |K_ij| |u_j| over the part of U that is no rigid motion: energies round as it does. Only where the force
  /// is linear.
  [[nodiscard]] virtual double energy_terms(const Vector& displacement) const;
};

/// Throws Error(invalid_input) that names who needs it, unless the force is linear.
void require_linear(const InternalForce& internal_force, const std::string& who);

/// K U, computed from U less its rigid motion, which has no part in it.
class LinearElasticity final : public InternalForce {
 public:
  /// K symmetric to the bit, dofs × dofs; `nodes`: reference positions, d × count.
  LinearElasticity(const SparseMatrix& stiffness, const Points& nodes);
  void evaluate(const Vector& displacement, Vector& force) const override;
  [[nodiscard]] double energy(const Vector& displacement) const override;
  [[nodiscard]] double energy(const Vector& displacement, const Vector& force) const override;
  void strain_force(const Vector& displacement, const Vector& increment, Vector& force) const override;
  [[nodiscard]] bool is_linear() const override { return true; }
  using InternalForce::tangent;
  [[nodiscard]] SparseMatrix tangent(const Vector&) const override { return stiffness_.whole(); }
  [[nodiscard]] const NodeMatrix* constant_tangent() const override { return &stiffness_; }
  [[nodiscard]] double energy_terms(const Vector& displacement) const override;

 private:
  RigidMotion rigid_;
  NodeMatrix stiffness_;
  mutable Vector deformation_;
};

}  // namespace ricochet
