#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/fem/strain_path.hpp"
#include "ricochet/linear_algebra/matrix_graph.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"
#include "ricochet/problem/rigid_motion.hpp"

/// @file Elastic response of the body: interface for internal force, tangent and energy. Linear elasticity has a
/// constant tangent; laws of finite strain do not (finite_elasticity.hpp).
namespace ricochet {

class ViscousForce;
class DistortionForce;

class InternalForce {
 public:
  virtual ~InternalForce() = default;
  /// Computes the nodal forces of the stress at displacement U (for linear elasticity K U). Throws
  /// Error(not_converged), with the cell in its message, if the displacement inverts a cell.
  virtual void evaluate(const Vector& displacement, Vector& force) const = 0;
  /// Strain energy (½UᵀKU for linear elasticity).
  [[nodiscard]] virtual double energy(const Vector& displacement) const = 0;
  /// Strain energy if the force that evaluate() returns at this displacement is known.
  [[nodiscard]] virtual double energy(const Vector& displacement, const Vector& force) const;
  /// Computes the forces, at a displacement `middle`, of the mean stress along the path of the strain from
  /// `middle` − ½ `increment` to `middle` + ½ `increment` (fem/strain_path.hpp). Their work on the increment, u₁ − u⁺
  /// of a step, is the change of the energy up to the error of the rule, and a rigid motion has none. Only for
  /// nonlinear forces; throws as evaluate() does.
  virtual void path_force(const Vector& middle, const Vector& increment, const PathRules& rules, Vector& force) const;
  /// Returns a ∂D/∂x + b ∂D/∂Δ̂ of the force D that path_force() computes, with a and b of the `variation`: in general
  /// not symmetric, with the pattern of tangent(). For solvers with the exact tangent; only for nonlinear forces.
  [[nodiscard]] virtual SparseMatrix path_tangent(const Vector& middle, const Vector& increment, const PathRules& rules,
                                                  const PathVariation& variation) const;
  /// Rules of path_force() for small changes of the strain, one per cell of the body; and raises the rules of the cells
  /// whose strain changes more. Returns whether any was raised. Only for nonlinear forces.
  [[nodiscard]] virtual PathRules path_rules() const;
  virtual bool raise_path_rules(const Vector& middle, const Vector& increment, PathRules& rules) const;
  /// Estimated time of an evaluation of the force, in seconds on one core of a common machine. It is a count, so that
  /// decisions do not depend on the load of the machine; 0 if unknown.
  [[nodiscard]] virtual double estimated_seconds() const { return 0.0; }
  /// Returns the contribution of the cells at some nodes (per node, 1: included): their forces and the energy of these
  /// cells alone. Only for nonlinear forces.
  [[nodiscard]] virtual std::shared_ptr<const InternalForce> restricted_to(const std::vector<char>& nodes) const;
  /// Adds the contribution that acts from the ground and is no stress: the force of springs at a displacement, as in
  /// evaluate().
  virtual void add_ground_force(const Vector& /*displacement*/, Vector& /*force*/) const {}
  /// Viscoelastic branches (viscous_force.hpp), excluded from every other function here; null if none.
  [[nodiscard]] virtual const ViscousForce* viscous() const { return nullptr; }
  /// Control of distorted cells (distortion_force.hpp); null if no cell can be inverted between its quadrature points.
  [[nodiscard]] virtual const DistortionForce* distortion() const { return nullptr; }
  /// Whether the force is a linear function of U, so that the tangent is constant. Code that relies on it checks it
  /// (require_linear).
  [[nodiscard]] virtual bool is_linear() const = 0;
  /// Returns ∂force/∂U at a displacement (empty: the undeformed body), symmetric, with a fixed sparsity
  /// pattern. Assembled anew in every call at the cost of some tens of evaluations: call it once, and do not
  /// keep the result longer than needed.
  [[nodiscard]] virtual SparseMatrix tangent(const Vector& displacement) const = 0;
  [[nodiscard]] SparseMatrix tangent() const { return tangent(Vector()); }
  /// Tangent if it is constant and stored; else null.
  [[nodiscard]] virtual const NodeMatrix* constant_tangent() const { return nullptr; }
  /// Diagonal of K of the undeformed body, and the graph of the nodes that its entries couple, with d dofs each.
  [[nodiscard]] Vector stiffness_diagonal() const;
  [[nodiscard]] MatrixGraph graph(int d) const;
  /// Σ |u_i| |K_ij| |u_j| over U minus its rigid part, the magnitude that determines the rounding error of
  /// energies. Only for linear forces.
  [[nodiscard]] virtual double energy_terms(const Vector& displacement) const;
};

/// Throws Error(invalid_input) that names `who` unless the force is linear.
void require_linear(const InternalForce& internal_force, const std::string& who);

/// K U, computed from U minus its rigid part, which K maps to zero.
class LinearElasticity final : public InternalForce {
 public:
  /// Requires K to be exactly symmetric, dofs × dofs; `nodes`: reference positions, d × count.
  LinearElasticity(const SparseMatrix& stiffness, const Points& nodes);
  void evaluate(const Vector& displacement, Vector& force) const override;
  [[nodiscard]] double energy(const Vector& displacement) const override;
  [[nodiscard]] double energy(const Vector& displacement, const Vector& force) const override;
  [[nodiscard]] bool is_linear() const override { return true; }
  using InternalForce::tangent;
  [[nodiscard]] SparseMatrix tangent(const Vector&) const override { return stiffness_.to_sparse(); }
  [[nodiscard]] const NodeMatrix* constant_tangent() const override { return &stiffness_; }
  [[nodiscard]] double energy_terms(const Vector& displacement) const override;

 private:
  RigidMotion rigid_;
  NodeMatrix stiffness_;
  mutable Vector deformation_;
};

}  // namespace ricochet
