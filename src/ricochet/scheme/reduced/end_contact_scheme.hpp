#pragma once

#include <optional>
#include <string>

#include "ricochet/scheme/reduced/finite_strain_step.hpp"
#include "ricochet/scheme/reduced/massless_contact_step.hpp"

/// @file Schemes whose steps are determined by contact conditions at their end: those of MasslessContactStep or, for a
/// nonlinear internal force, of FiniteStrainStep. They differ in the reactions that act over the step.
namespace ricochet {

class EndContactScheme : public Scheme {
 public:
  EndContactScheme(const std::string& name, double step, bool supports_free_bodies = true)
      : Scheme(step, {.acting_instant = -0.5,
                      .supports_step_changes = true,
                      .supports_nonlinear_force = true,
                      .supports_relaxation = true,
                      .supports_free_bodies = supports_free_bodies,
                      .conserves_moments_at_finite_strain = true,
                      .corrects_velocities = true,
                      .suits_singular_mass = true,
                      .jump_response = JumpResponse::undamped}),
        massless_step_(name, step) {}

  void analyse(const SemidiscreteProblem& problem) override {
    massless_step_.analyse(problem);
    if (!problem.internal_force->is_linear()) finite_strain_step_.emplace().analyse(problem, step());
  }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    return finite_strain_step_ ? FiniteStrainStep::operators(problem, step(), acting_of(problem))
                               : massless_step_.operators(problem, acting_of(problem));
  }
  [[nodiscard]] ProblemTraits traits_for(const SemidiscreteProblem& problem) const override {
    if (!problem.has_contact_dofs()) return {};
    return {.acting_reactions = acting(problem)};
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    if (finite_strain_step_) {
      finite_strain_step_->advance({problem, acting_of(problem), step(), state, stages}, increment);
    } else {
      massless_step_.advance(problem, acting_of(problem), state, stages, increment);
    }
  }
  /// At finite strain the forces of a step act at its middle x, with couples between bodies.
  [[nodiscard]] LastStep last_step() const override {
    if (!finite_strain_step_) return {.corrections = massless_step_.corrections()};
    return {.corrections = finite_strain_step_->corrections(),
            .displacement_of_forces = &finite_strain_step_->middle(),
            .has_couples_between_bodies = true};
  }

 protected:
  [[nodiscard]] const MasslessContactStep& massless_step() const { return massless_step_; }
  [[nodiscard]] MasslessContactStep& massless_step() { return massless_step_; }
  [[nodiscard]] bool has_finite_strain() const { return finite_strain_step_.has_value(); }
  void step_changed(const SemidiscreteProblem& problem) override { massless_step_.change_step(problem, step()); }

 private:
  /// Reactions that act over a step if there are contact dofs.
  [[nodiscard]] virtual ActingReaction acting(const SemidiscreteProblem& problem) const = 0;
  [[nodiscard]] ActingReaction acting_of(const SemidiscreteProblem& problem) const {
    return !problem.has_contact_dofs() ? ActingReaction::end : acting(problem);
  }

  MasslessContactStep massless_step_;
  std::optional<FiniteStrainStep> finite_strain_step_;  ///< for a nonlinear internal force
};

}  // namespace ricochet
