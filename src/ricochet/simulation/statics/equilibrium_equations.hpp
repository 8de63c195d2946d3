#pragma once

#include "ricochet/linear_algebra/qr_anderson_acceleration.hpp"
#include "ricochet/simulation/statics/static_equilibrium.hpp"
#include "ricochet/solver/exact/exact_stage.hpp"
#include "ricochet/step/contact_newton.hpp"
#include "ricochet/step/contact_tangent.hpp"
#include "ricochet/step/tangent_assembly.hpp"

/// @file Equations of an equilibrium at finite strain.
///
/// For a part λ of the loads and prescribed displacements at t = 0: f(U) = λ L + λ P(U) + Hᵀρ, with the contact
/// conditions at U, and friction that opposes the slip since the beginning of the part. An iteration solves
///   (J + εM) δ = λ (L + P) − f + Hᵀρ,   U += δ.
/// Bodies that overlap before the first part are pushed out as the parts grow: gaps are g(U) + (1−λ) max(0, −g₀). With
/// ε > 0 bodies that only contact holds are treated by the proximal point method (static_equilibrium.hpp).
namespace ricochet {

/// Present iterate, and the forces there.
class EquilibriumIterate {
 public:
  EquilibriumIterate(const SemidiscreteProblem& problem, const Vector& guess);

  /// Begins a part from the present displacement; slips are measured from there.
  void start(double part);
  /// Computes f, and λ(L + P) − f. Throws Error(not_converged) where a cell is inverted.
  void evaluate();
  void halve() { displacement_ = 0.5 * (displacement_ + last_); }
  void begin_correction() { last_ = displacement_; }
  void take_correction_back() { displacement_ = last_; }
  /// The linear stage at the iterate.
  [[nodiscard]] Stage stage() const;
  /// Stores the reactions of an iteration.
  void store(const Stage& stage, const StageSolution& solution);
  /// Returns whether forces and the reactions of the last iteration are balanced, at unsupported dofs.
  [[nodiscard]] bool is_balanced() const;
  [[nodiscard]] NewtonEquations::Iteration sizes() const;

  [[nodiscard]] const SemidiscreteProblem& problem() const { return problem_; }
  [[nodiscard]] double epsilon() const { return epsilon_; }
  [[nodiscard]] double part() const { return part_; }
  [[nodiscard]] double rounding() const;
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] Vector& displacement() { return displacement_; }
  [[nodiscard]] const Vector& displacement() const { return displacement_; }
  [[nodiscard]] const Vector& origin() const { return origin_; }
  [[nodiscard]] const Reactions& reactions() const { return reactions_; }
  void set_reactions(const Reactions& reactions) { reactions_ = reactions; }

 private:
  const SemidiscreteProblem& problem_;
  double epsilon_, size_;
  double stiffness_;  ///< largest K_ii
  double part_ = 0.0;
  Vector displacement_, last_, origin_;
  Vector load_, supported_, force_, right_hand_side_;
  Vector overlap_;       ///< max(0, −g₀) per contact point
  Reactions reactions_;  ///< of the last iteration
  std::shared_ptr<const ContactRows> rows_;
};

/// Common part of the iterations of these equations.
class EquilibriumEquations : public NewtonEquations {
 public:
  explicit EquilibriumEquations(EquilibriumIterate& iterate) : iterate_(iterate) {}
  Iteration iterate() override;
  void evaluate() override { iterate_.evaluate(); }
  void halve() override { iterate_.halve(); }
  [[nodiscard]] bool has_conditions_on_solution() const override { return settles_; }
  [[nodiscard]] bool accept(const Iteration& iteration, bool may_refuse) override;
  [[nodiscard]] bool freeze() override { return iterate_.problem().contact.freeze_pairs(); }
  /// Makes iterations go on until the residual of all forces is rounding, and corrections no longer shrink: rounding of
  /// a motion that only contact restrains is amplified by 1/ε, so that the size of the smallest correction is unknown.
  void settle() {
    settles_ = true;
    refusals_ = 0;
  }

 protected:
  /// Solves the linear equations, and moves to their solution.
  virtual void correct() = 0;
  EquilibriumIterate& iterate_;

 private:
  bool settles_ = false;
  int refusals_ = 0;
  double last_correction_ = 0.0;
};

/// Iterations with the factor of an earlier displacement.
class KeptFactorEquilibrium : public EquilibriumEquations {
 public:
  KeptFactorEquilibrium(EquilibriumIterate& iterate, const StepSolverOptions& options);
  void accelerate() override;
  void forget_iterates() override { acceleration_.restart(); }
  void renew() override { solver_->renew_operators(iterate_.displacement(), iterate_.displacement()); }
  [[nodiscard]] double renewal_price() const { return solver_->renewal_price(); }

 private:
  void correct() override;

  std::unique_ptr<StepSolver> solver_;
  StageSolution solution_;
  QrAndersonAcceleration acceleration_{NewtonThresholds().stored_iterations};
  Vector point_;
};

/// Iterations with the exact tangent.
class ExactEquilibrium : public EquilibriumEquations {
 public:
  explicit ExactEquilibrium(EquilibriumIterate& iterate);
  void set_proximal_weight(double weight) override { proximal_weight_ = weight; }
  void take_back() override;
  /// Number of directions in which an equilibrium is unstable: negative eigenvalues of its tangent on the motions that
  /// closed contact admits. `direction`, per dof, is one of them.
  [[nodiscard]] Index unstable_directions(Vector& direction);
  /// Least proximal weight of a few with which the tangent is positive definite on these motions.
  [[nodiscard]] double least_definite_weight();

 private:
  void make_held_tangent(SparseMatrix& matrix);
  void correct() override;
  void assemble(const Stage& stage);

  TangentAssembly::Equations equation_;
  TangentAssembly::Motions motions_;
  Index unknowns_ = 0;
  TangentAssembly assembly_;
  ContactTangent contact_;
  ExactTangent tangent_;
  ExactStage exact_stage_;
  SparseMatrix undeformed_;  ///< K₀, once it is needed
  double proximal_weight_ = 0.0;
  StageSolution solution_;
  Reactions last_reactions_;
  Vector solved_;
};

}  // namespace ricochet
