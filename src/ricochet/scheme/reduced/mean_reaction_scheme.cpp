#include "ricochet/scheme/reduced/end_contact_scheme.hpp"

namespace ricochet {

namespace {

/// Contact nodes in equilibrium, and over a step the mean of the reactions along the straight path of the gaps
/// (massless_contact_step.hpp, mean_reaction.hpp, μ = 0): without friction this mean is the discrete gradient of the
/// potential of the contact nodes, so
///   E₁ − E₀ = work of loads, supports and obstacles,
/// contact does no work, and momenta are exact; each step has one solution, however long it is. Beyond the time in
/// which a wave crosses a cell the end reactions alternate: reduced-kane is for such steps.
class MeanReactionScheme final : public EndContactScheme {
 public:
  explicit MeanReactionScheme(double step) : EndContactScheme("mean-reaction", step) {}

  void analyse(const SemidiscreteProblem& problem) override {
    EndContactScheme::analyse(problem);
    massless_step().require_frictionless_planes(problem);
  }
  [[nodiscard]] ProblemTraits traits_for(const SemidiscreteProblem& problem) const override {
    ProblemTraits traits = EndContactScheme::traits_for(problem);
    traits.long_steps.consequence =
        "the contact forces at the ends of steps oscillate: those of a block at rest alternated between zero "
        "and four times its weight at ten crossings, without end (their means, which act, do not)";
    return traits;
  }

 private:
  [[nodiscard]] ActingReaction acting(const SemidiscreteProblem&) const override { return ActingReaction::path_mean; }
};

}  // namespace

SchemeRegistration mean_reaction_scheme() {
  return {"mean-reaction", [](double step, const Parameters&) { return std::make_unique<MeanReactionScheme>(step); }};
}

}  // namespace ricochet
