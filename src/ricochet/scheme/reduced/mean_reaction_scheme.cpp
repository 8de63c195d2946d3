#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/scheme/reduced/massless_layer.hpp"
#include "ricochet/scheme/reduced/requirements.hpp"

namespace ricochet {

namespace {

/// Contact nodes in equilibrium, and over a step the mean of the reactions along the straight path of the gaps
/// (massless_layer.hpp, mean_reaction.hpp, μ = 0): without friction the potential of the contact nodes has this mean as
/// its discrete gradient, so
///   E₁ − E₀ = work of loads, supports and obstacles,
/// the contact works nothing, and momenta are exact; each step has one solution, however long it is. Beyond the time in
/// which a wave crosses a cell the end reactions alternate: reduced-kane is for such steps.
class MeanReactionScheme final : public Scheme {
 public:
  explicit MeanReactionScheme(double step) : Scheme(step), layer_("mean-reaction", step) {}

  void analyse(const SemidiscreteProblem& problem) override {
    layer_.analyse(problem);
    require_frictionless_planes(problem, layer_, "mean-reaction");
  }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    return layer_.operators(problem, mean(problem));
  }
  [[nodiscard]] double acting_instant() const override { return -0.5; }
  [[nodiscard]] bool suits_singular_mass() const override { return true; }
  [[nodiscard]] LongSteps long_steps(const SemidiscreteProblem&) const override {
    return {.trouble =
                "the contact forces at the ends of steps rattle: those of a block at rest alternated between "
                "nothing and four times its weight at ten crossings, for ever (their means, which act, do not)"};
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    layer_.advance(problem, mean(problem), state, stages, increment);
  }
  [[nodiscard]] StepCorrections step_corrections(const SemidiscreteProblem&) const override {
    return layer_.corrections();
  }

 private:
  [[nodiscard]] static ReactionMean mean(const SemidiscreteProblem& problem) {
    return problem.contact_dofs.empty() ? ReactionMean::end : ReactionMean::path;
  }

  MasslessLayer layer_;
};

}  // namespace

SchemeRegistration mean_reaction_scheme() {
  return {"mean-reaction", [](double step, const Parameters&) { return std::make_unique<MeanReactionScheme>(step); }};
}

}  // namespace ricochet
