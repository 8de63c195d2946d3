#include "ricochet/scheme/central/central_scheme.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Central differences with forces that stop a node at the obstacle: κ = 0 and
///   0 ≤ r_N ⟂ g(Uⁿ⁺¹) ≥ 0,   friction on the slip rate B_T (Uⁿ⁺¹−Uⁿ)/h.
/// This is the position form of the contact of L. M. Taylor and D. P. Flanagan's PRONTO 3D (Sandia report SAND87-1912,
/// 1989), r = −m g*/h² with g* the gap at the end of a step without contact, written for every mass matrix; the forward
/// increment multipliers of N. J. Carpenter, R. L. Taylor and M. G. Katona (Int. J. Numer. Meth. Engng. 32 (1991)
/// 103–128) are identical. Its normal part is that of Paoli and Schatzman with e = 0: contact changes the energy by −½
/// r_N·g(Uⁿ⁻¹) ≤ 0. (Elsewhere the name denotes r = −m G V*/h, which holds a node at its position, apart from the
/// obstacle.)
class TaylorFlanagan final : public CentralScheme {
 public:
  explicit TaylorFlanagan(double step) : CentralScheme("taylor-flanagan", step, 0.0, "") {}

 private:
  void require_contact(const SemidiscreteProblem& problem, const Instant& instant, Stage& stage) override {
    next_ = instant.now + instant.ahead;
    require_no_penetration(problem, next_, instant.time + step(), stage);
    require_friction(problem, instant.velocity, 1.0 / step(), stage);
  }

  Vector next_;
};

}  // namespace

SchemeRegistration taylor_flanagan_scheme() {
  return {"taylor-flanagan", [](double step, const Parameters&) { return std::make_unique<TaylorFlanagan>(step); }};
}

}  // namespace ricochet
