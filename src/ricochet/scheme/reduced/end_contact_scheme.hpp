#pragma once

#include <string>

#include "ricochet/scheme/reduced/massless_contact_step.hpp"

/// @file Schemes whose steps are determined by contact conditions at their end (MasslessContactStep::advance). They
/// differ in the reactions that act over the step.
namespace ricochet {

class EndContactScheme : public Scheme {
 public:
  EndContactScheme(const std::string& name, double step) : Scheme(step), massless_step_(name, step) {}

  [[nodiscard]] bool supports_step_changes() const override { return true; }
  [[nodiscard]] bool supports_nonlinear_force() const override { return true; }
  [[nodiscard]] bool supports_relaxation() const override { return true; }
  [[nodiscard]] bool supports_free_bodies() const override { return true; }
  [[nodiscard]] bool conserves_moments_at_finite_strain() const override { return true; }
  [[nodiscard]] const Vector* displacement_of_forces() const override {
    return massless_step_.displacement_of_forces();
  }
  [[nodiscard]] bool has_couples_between_bodies() const override {
    return massless_step_.displacement_of_forces() != nullptr;
  }
  void analyse(const SemidiscreteProblem& problem) override { massless_step_.analyse(problem); }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    return massless_step_.operators(problem, mean_of(problem));
  }
  [[nodiscard]] double acting_instant() const override { return -0.5; }
  [[nodiscard]] JumpResponse jump_response() const override { return JumpResponse::alternates; }
  [[nodiscard]] bool suits_singular_mass() const override { return true; }
  [[nodiscard]] std::optional<ReactionMean> acting_reactions(const SemidiscreteProblem& problem) const override {
    return !problem.has_contact_dofs() ? std::nullopt : std::optional(mean(problem));
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    massless_step_.advance(problem, mean_of(problem), state, stages, increment);
  }
  [[nodiscard]] StepCorrections step_corrections(const SemidiscreteProblem&) const override {
    return massless_step_.corrections();
  }

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
