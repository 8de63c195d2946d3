#pragma once

#include <string>

#include "ricochet/scheme/reduced/massless_contact_step.hpp"

/// @file Schemes whose steps are determined by contact conditions at their end (MasslessContactStep::advance). They
/// differ in the reactions that act over the step.
namespace ricochet {

class EndContactScheme : public Scheme {
 public:
  EndContactScheme(const std::string& name, double step)
      : Scheme(step, {.acting_instant = -0.5,
                      .supports_step_changes = true,
                      .supports_nonlinear_force = true,
                      .supports_relaxation = true,
                      .supports_free_bodies = true,
                      .conserves_moments_at_finite_strain = true,
                      .suits_singular_mass = true,
                      .jump_response = JumpResponse::alternates}),
        massless_step_(name, step) {}

  void analyse(const SemidiscreteProblem& problem) override { massless_step_.analyse(problem); }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    return massless_step_.operators(problem, mean_of(problem));
  }
  [[nodiscard]] ProblemTraits traits_for(const SemidiscreteProblem& problem) const override {
    if (!problem.has_contact_dofs()) return {};
    return {.acting_reactions = mean(problem)};
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    massless_step_.advance(problem, mean_of(problem), state, stages, increment);
  }
  [[nodiscard]] LastStep last_step() const override { return massless_step_.last_step(); }

 protected:
  [[nodiscard]] const MasslessContactStep& massless_step() const { return massless_step_; }
  void step_changed(const SemidiscreteProblem& problem) override { massless_step_.change_step(problem, step()); }

 private:
  /// Mean that acts over a step if there are contact dofs.
  [[nodiscard]] virtual ReactionMean mean(const SemidiscreteProblem& problem) const = 0;
  [[nodiscard]] ReactionMean mean_of(const SemidiscreteProblem& problem) const {
    return !problem.has_contact_dofs() ? ReactionMean::end : mean(problem);
  }

  MasslessContactStep massless_step_;
};

}  // namespace ricochet
