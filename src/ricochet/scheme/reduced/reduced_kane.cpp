#include <fmt/format.h>

#include <utility>

#include "ricochet/base/log.hpp"
#include "ricochet/scheme/reduced/end_contact_scheme.hpp"

namespace ricochet {

namespace {

/// In the scheme of C. Kane, E. A. Repetto, M. Ortiz and J. E. Marsden (Comput. Methods Appl. Mech. Engrg. 180 (1999)
/// 1–26) the reactions of the end of the step act over all of it. Here nodes without inertia are in equilibrium with
/// them, and the others follow the midpoint rule (massless_contact_step.hpp, ρ̄ = ρ): with z the change of the contact
/// nodes' displacement relative to the others,
///   E₁ − E₀ = −r_N·g₀ − Σ F r_N |Δy_T| − ½ zᵀK_cc z + work of loads, supports, obstacles and damping,
/// each of the first three parts ≤ 0 at each point, for every step and friction. With weight "adaptive" ρ̄ is a mean
/// (mean_reaction.hpp) whose parts have the same signs, and which loses much less at impacts.
class ReducedKane final : public EndContactScheme {
 public:
  ReducedKane(double step, const std::string& weight) : EndContactScheme("reduced-kane", step), weight_(weight) {}

  void analyse(const SemidiscreteProblem& problem) override {
    EndContactScheme::analyse(problem);
    if (weight_ == "end" || !problem.has_contact_dofs() || has_mean(problem)) return;
    if (weight_ == "automatic" && problem.contact.has_friction()) return;
    if (std::exchange(mixed_mean_logged_, true)) return;  // `validate` analyses first, and then starts a run
    log::info(fmt::format("time.reaction_weight = \"{}\": the reactions at the end of each step act, since {}", weight_,
                          problem.contact.follows_motion() ? "contact directions follow the motion"
                          : has_finite_strain_friction(problem)
                              ? "at finite strain the work of friction is that of the reactions at the end"
                              : "contact nodes have stiffness damping"));
  }

  [[nodiscard]] ProblemTraits traits_for(const SemidiscreteProblem& problem) const override {
    ProblemTraits traits = EndContactScheme::traits_for(problem);
    if (traits.acting_reactions == ActingReaction::end && has_mean(problem))
      traits.less_dissipative_setting = "time.reaction_weight = \"adaptive\"";
    return traits;
  }

 private:
  /// True if the balance of a step has no term for the work of friction along a path (finite_strain_step.hpp).
  [[nodiscard]] static bool has_finite_strain_friction(const SemidiscreteProblem& problem) {
    return problem.contact.has_friction() && !problem.internal_force->is_linear();
  }
  /// True if a mean is possible: it requires linear gaps, and nodes without memory.
  [[nodiscard]] bool has_mean(const SemidiscreteProblem& problem) const {
    return !problem.contact.follows_motion() && !massless_step().damps_contact_nodes() &&
           !has_finite_strain_friction(problem);
  }
  [[nodiscard]] ActingReaction acting(const SemidiscreteProblem& problem) const override {
    // Sliding without damping flutters, less so under the end reactions.
    const bool is_requested = weight_ == "adaptive" || (weight_ == "automatic" && !problem.contact.has_friction());
    return is_requested && has_mean(problem) ? ActingReaction::mixed_mean : ActingReaction::end;
  }

  std::string weight_;
  bool mixed_mean_logged_ = false;
};

}  // namespace

SchemeRegistration reduced_kane_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<ReducedKane>(step, parameters.text("reaction_weight"));
  };
  return {
      "reduced-kane",
      make,
      {choice_key("reaction_weight", {"automatic", "adaptive", "end"}, {.default_value = "automatic"},
                  "Reactions that act over a step. \"adaptive\", for impacts: a mean over the step, as close to the "
                  "exact mean as smooth reactions allow (on planes, without stiffness damping at contact nodes; "
                  "otherwise as \"end\"). \"end\", for sliding: the reactions at the end of the step, which lose more "
                  "energy. \"automatic\": \"end\" with friction, otherwise \"adaptive\".")}};
}

}  // namespace ricochet
