#pragma once

#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/step/contact_tangent.hpp"
#include "ricochet/step/tangent_assembly.hpp"

/// @file Exact tangent of the step of finite_strain_step.hpp.
///
/// Unknowns are the increments of x on all dofs that are neither supported nor tied, and those of u₁ on contact dofs.
/// On the others u₁ = 2x − u₀ and Δ̂ = 2(x − u₀), on contact dofs Δ̂ = 2(u₁ − x), so that with ∂D of
/// InternalForce::path_tangent()
///   J = [ 4/h² M + 2/h C + ∂D/∂x ± 2 ∂D/∂Δ̂,  2 ∂D/∂Δ̂ − ∂(Hᵀρ)/∂u₁ ;  2 K_cf,  K_cc − ∂(Hᵀρ)/∂u₁ ],   K = f'(u₁),
/// with + on the columns of other dofs and − on those of contact dofs, and with −∂P/∂x of loads that follow the
/// surface. A proximal weight θ adds θ K₀ to both diagonal blocks, K₀ = f'(0): iterations then move to the solution as
/// a descent in the metric of the undeformed body does, by implicit steps of length 1/θ.
namespace ricochet {

/// Present iterate of a step.
struct StepIterate {
  const SemidiscreteProblem& problem;
  const InternalForce* contact_cells;  ///< of the cells at contact nodes alone; null if there are none
  double step;                         ///< h
  const State& state;                  ///< at the start
  const PathRules& rules;
  const Vector& middle;          ///< x
  const Vector& end;             ///< u₁
  const Vector& path_increment;  ///< Δ̂
  const Vector& imbalance;       ///< of forces at the middle, without those of contact, per dof
  const Vector& end_imbalance;   ///< L₁ + P(u₁) − f(u₁), per dof; used on contact dofs
  const Stage& stage;  ///< rows and conditions at u₁, of which m is half of the motion of u₁, and δ at supports

  [[nodiscard]] BranchStep branches() const {
    return {middle, path_increment, state.displacement, end, state.internal_strain, step};
  }
};

class FiniteStrainTangent {
 public:
  /// Numbers the unknowns of a problem.
  void analyse(const SemidiscreteProblem& problem);
  /// Linearizes the equations about an iterate, with the forces of these reactions and a proximal weight θ.
  void assemble(const StepIterate& at, const Reactions& reactions, double proximal_weight, ExactTangent& tangent);
  /// Computes the increments of x and u₁ per dof from the unknowns.
  void write_increments(const Vector& unknowns, Vector& middle, Vector& end) const;

 private:
  using Equations = TangentAssembly::Equations;
  using Motions = TangentAssembly::Motions;
  void add_forces(const StepIterate& at);
  void add_proximal_terms(const SemidiscreteProblem& problem, double weight);
  void add_contact(const StepIterate& at, const Reactions& reactions, ExactTangent& tangent);

  Index count_ = 0;                            ///< of unknowns
  Equations equation_, end_equation_;          ///< of x and of u₁
  Motions middle_, end_, path_, path_of_end_;  ///< motions of x, u₁, and Δ̂ by x and by u₁
  Motions own_, own_at_end_;                   ///< those of x and u₁ by their own unknowns
  SparseMatrix undeformed_;                    ///< K₀, once it is needed
  TangentAssembly assembly_;
  ContactTangent contact_;
};

}  // namespace ricochet
