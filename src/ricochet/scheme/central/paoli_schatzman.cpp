#include "ricochet/base/error.hpp"
#include "ricochet/scheme/central/central_scheme.hpp"
#include "ricochet/scheme/restitution_key.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Scheme of L. Paoli and M. Schatzman (SIAM J. Numer. Anal. 40 (2002) 702–733) with restitution e, as a multiplier of
/// the positions: κ = ¼ or 0, and
///   0 ≤ r_N ⟂ g(Uⁿ⁺¹) + e g(Uⁿ⁻¹) ≥ 0,   friction on the slip rate B_T Vⁿ.
/// Contact changes the energy by r_N·G(Uⁿ⁺¹−Uⁿ⁻¹)/2 = −½(1+e) r_N·g(Uⁿ⁻¹) if gaps are linear and obstacles rest: with
/// e = 0 no point penetrates and none creates energy; e > 0 admits a penetration of e times the previous gap, and a
/// previous gap that was negative can create energy.
class PaoliSchatzman final : public CentralScheme {
 public:
  PaoliSchatzman(double step, double restitution, bool is_explicit)
      : CentralScheme("paoli-schatzman", step, is_explicit ? 0.0 : 0.25, "without it their oscillations grow"),
        restitution_(restitution) {}

  void analyse(const SemidiscreteProblem& problem) override {
    CentralScheme::analyse(problem);
    if (restitution_ == 0.0 || !problem.contact.follows_motion()) return;
    throw Error(ErrorKind::invalid_input,
                "scheme \"paoli-schatzman\" does not support restitution at curved obstacles, where gaps are not "
                "linear functions of the displacement; set time.restitution = 0");
  }

 private:
  void require_contact(const SemidiscreteProblem& problem, const Instant& instant, Stage& stage) override {
    next_ = instant.now + instant.ahead;
    require_no_penetration(problem, next_, instant.time + step(), stage);
    if (restitution_ > 0.0) {
      problem.gaps(instant.before.displacement, instant.before.time, gap_before_);
      stage.conditions.gap.offset += restitution_ * gap_before_;
      stage.conditions.gap.rounding *= 1.0 + restitution_;
    }
    require_friction(problem, instant.velocity, 0.5 / step(), stage);
  }

  double restitution_;
  Vector next_, gap_before_;
};

}  // namespace

SchemeRegistration paoli_schatzman_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<PaoliSchatzman>(step, parameters.number("restitution"),
                                            parameters.text("stiffness") == "explicit");
  };
  return {"paoli-schatzman",
          make,
          {restitution_key(),
           choice_key("stiffness", {"implicit", "explicit"}, {.default_value = "implicit"},
                      "Elastic forces at a mean of three instants (\"implicit\"), or at the middle one (\"explicit\"), "
                      "which requires mass \"lumped\" and a short step.")}};
}

}  // namespace ricochet
