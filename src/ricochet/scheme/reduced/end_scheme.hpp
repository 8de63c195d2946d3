#pragma once

#include <string>

#include "ricochet/scheme/reduced/massless_layer.hpp"

/// @file Schemes whose steps are determined by contact conditions at their end (MasslessLayer::advance). They differ in
/// the reactions that act over the step.
namespace ricochet {

class EndScheme : public Scheme {
 public:
  EndScheme(const std::string& name, double step) : Scheme(step), layer_(name, step) {}

  [[nodiscard]] bool changes_step() const override { return true; }
  [[nodiscard]] bool takes_nonlinear_force() const override { return true; }
  [[nodiscard]] bool takes_relaxation() const override { return true; }
  [[nodiscard]] bool takes_free_bodies() const override { return true; }
  [[nodiscard]] bool keeps_moments_at_finite_strain() const override { return true; }
  [[nodiscard]] const Vector* place_of_forces() const override { return layer_.place_of_forces(); }
  [[nodiscard]] bool has_couples_between_bodies() const override { return layer_.place_of_forces() != nullptr; }
  void analyse(const SemidiscreteProblem& problem) override { layer_.analyse(problem); }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    return layer_.operators(problem, mean_of(problem));
  }
  [[nodiscard]] double acting_instant() const override { return -0.5; }
  [[nodiscard]] bool suits_singular_mass() const override { return true; }
  [[nodiscard]] std::optional<ReactionMean> acting_reactions(const SemidiscreteProblem& problem) const override {
    return !problem.has_contact_dofs() ? std::nullopt : std::optional(mean(problem));
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    layer_.advance(problem, mean_of(problem), state, stages, increment);
  }
  [[nodiscard]] StepCorrections step_corrections(const SemidiscreteProblem&) const override {
    return layer_.corrections();
  }

 protected:
  [[nodiscard]] const MasslessLayer& layer() const { return layer_; }
  void step_changed(const SemidiscreteProblem& problem) override { layer_.change_step(problem, step()); }

 private:
  /// Mean that acts over a step if there are contact dofs.
  [[nodiscard]] virtual ReactionMean mean(const SemidiscreteProblem& problem) const = 0;
  [[nodiscard]] ReactionMean mean_of(const SemidiscreteProblem& problem) const {
    return !problem.has_contact_dofs() ? ReactionMean::end : mean(problem);
  }

  MasslessLayer layer_;
};

}  // namespace ricochet
