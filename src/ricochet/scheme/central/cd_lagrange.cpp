#include "ricochet/scheme/central/central_scheme.hpp"
#include "ricochet/scheme/restitution_key.hpp"

namespace ricochet {

namespace {

/// CD-Lagrange, central differences with impulses (F.-E. Fekak, M. Brun, A. Gravouil, B. Depale, Comput. Mech. 60
/// (2017) 547–567): κ = 0, and with the velocities V^{n±½} = ±(U^{n±1}−Uⁿ)/h, relative to the obstacle,
///   gⁿ > 0 ⇒ r_N = 0,   gⁿ ≤ 0 ⇒ 0 ≤ r_N ⟂ G V^{n+½} + e G V^{n−½} ≥ 0,   friction on the slip rate B_T V^{n+½}.
/// h r are impulses; V^{n+½} = V^{n−½} + δ/h. Contact changes the energy by ½h r_N·G(V^{n+½}+V^{n−½}). As long as
/// contact nodes approach, this is minus the energy lost in an impact, ½(1−e²)m|G V|² at each node; at a point that
/// touches and separates it can have either sign. Points penetrate by up to their motion in a step.
class CdLagrange final : public CentralScheme {
 public:
  CdLagrange(double step, double restitution)
      : CentralScheme("cd-lagrange", step, 0.0, ""), restitution_(restitution) {}

 private:
  void require_contact(const SemidiscreteProblem& problem, const Instant& instant, Stage& stage) override {
    const double h = step();
    equations().require_impact_law(problem, instant.now, instant.time, instant.velocity, instant.velocity, 1.0 / h,
                                   restitution_, h, stage);
    equations().require_friction_beside_rates(problem, instant.velocity, 1.0 / h, stage);
  }

  double restitution_;
};

}  // namespace

SchemeRegistration cd_lagrange_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<CdLagrange>(step, parameters.number("restitution"));
  };
  return {"cd-lagrange", make, {restitution_key()}};
}

}  // namespace ricochet
