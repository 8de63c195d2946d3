#include "ricochet/scheme/central/central_scheme.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Energy-conserving scheme of the source's section 4, with the contact condition on velocities: κ = ¼ and
///   gⁿ > 0 ⇒ r_N = 0,   gⁿ ≤ 0 ⇒ 0 ≤ r_N ⟂ G Vⁿ ≥ 0,   friction on the slip rate B_T Vⁿ.
/// J((Uⁿ+Uⁿ⁺¹)/2, (Uⁿ⁺¹−Uⁿ)/h) is conserved exactly, since r_Nⁿ does no work on (Uⁿ⁺¹−Uⁿ⁻¹)/2; friction dissipates h
/// r_T·w ≥ 0.
/// (Massless dofs would follow K_cc (Uⁿ⁺¹+2Uⁿ+Uⁿ⁻¹)/4 = …, whose characteristic polynomial (z+1)² has a double root:
/// they oscillate from step to step with a linearly growing amplitude, which the half-step energy does not show.)
class KlrConserving final : public CentralScheme {
 public:
  explicit KlrConserving(double step)
      : CentralScheme("klr-conserving", step, 0.25, "without it their oscillations grow") {}

 private:
  void require_contact(const SemidiscreteProblem& problem, const Instant& instant, Stage& stage) override {
    const double h = step();
    require_no_approach(problem, instant.now, instant.time, instant.velocity, 0.5 / h, stage.obstacle, h, stage);
    equations().require_friction_beside_rates(problem, instant.velocity, 0.5 / h, stage);
  }
};

}  // namespace

SchemeRegistration klr_conserving_scheme() {
  return {"klr-conserving", [](double step, const Parameters&) { return std::make_unique<KlrConserving>(step); }};
}

}  // namespace ricochet
