#pragma once

#include "ricochet/scheme/reduced/finite_strain_iterate.hpp"
#include "ricochet/scheme/reduced/finite_strain_tangent.hpp"

/// @file Iterations of a step at finite strain with its exact tangent (finite_strain_tangent.hpp).
namespace ricochet {

class ExactTangentEquations : public FiniteStrainEquations {
 public:
  using FiniteStrainEquations::FiniteStrainEquations;
  /// Numbers the unknowns of a problem.
  void analyse(const SemidiscreteProblem& problem) { tangent_.analyse(problem); }
  /// Begins with the reactions of the last step.
  void start(const State& state);

  Iteration iterate() override;
  void set_proximal_weight(double weight) override { proximal_weight_ = weight; }
  void take_back() override;
  [[nodiscard]] const StageSolution& solution() const override { return solution_; }

 private:
  FiniteStrainTangent tangent_;
  ExactTangent equations_;
  double proximal_weight_ = 0.0;
  StageSolution solution_, last_solution_;  ///< only their reactions
  Vector unknowns_, end_residual_, no_motion_;
  StepPositions correction_;
};

}  // namespace ricochet
