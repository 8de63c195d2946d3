#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

// The schemes, each by the function of its own file that registers it. One line each, in the order of the
// documentation.
// clang-format off
#define RICOCHET_SCHEMES(scheme) \
  scheme(midpoint_scheme)        \
  scheme(klr_conserving_scheme)  \
  scheme(newmark_scheme)         \
  scheme(semi_explicit_scheme)   \
  scheme(contact_stabilized_scheme)
// clang-format on

#define RICOCHET_DECLARE(registration) SchemeRegistration registration();
RICOCHET_SCHEMES(RICOCHET_DECLARE)
#undef RICOCHET_DECLARE

Registry<SchemeConstructor>& scheme_registry() {
#define RICOCHET_REGISTER(registration) registration(),
  static Registry<SchemeConstructor> registry("scheme", {RICOCHET_SCHEMES(RICOCHET_REGISTER)});
#undef RICOCHET_REGISTER
  return registry;
}

std::unique_ptr<Scheme> make_scheme(const std::string& name, double step, Parameters parameters) {
  return scheme_registry().find(name, parameters).type(step, parameters);
}

void Scheme::energy_state(const State& state, Vector& displacement, Vector& velocity) const {
  displacement = state.displacement;
  velocity = state.velocity;
}

}  // namespace ricochet
