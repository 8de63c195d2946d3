#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

// Schemes, each by the registration function of its own file. One line each, in the order of the documentation.
// clang-format off
#define RICOCHET_SCHEMES(scheme)    \
  scheme(midpoint_scheme)           \
  scheme(klr_conserving_scheme)     \
  scheme(newmark_scheme)            \
  scheme(semi_explicit_scheme)      \
  scheme(contact_stabilized_scheme) \
  scheme(reduced_kane_scheme)       \
  scheme(mean_reaction_scheme)      \
  scheme(reduced_midpoint_scheme)   \
  scheme(kane_scheme)               \
  scheme(generalized_alpha_scheme)  \
  scheme(hht_alpha_scheme)          \
  scheme(wbz_alpha_scheme)          \
  scheme(bathe_scheme)              \
  scheme(laursen_chawla_scheme)     \
  scheme(moreau_jean_scheme)        \
  scheme(paoli_schatzman_scheme)    \
  scheme(cd_lagrange_scheme)        \
  scheme(taylor_flanagan_scheme)    \
  scheme(laursen_love_scheme)       \
  scheme(penalty_midpoint_scheme)   \
  scheme(nitsche_scheme)            \
  scheme(nonsmooth_generalized_alpha_scheme)
// clang-format on

RICOCHET_DEFINE_REGISTRY(scheme_registry, SchemeConstructor, "scheme", RICOCHET_SCHEMES)

std::unique_ptr<Scheme> make_scheme(const std::string& name, double step, Parameters parameters) {
  return scheme_registry().find(name, parameters).type(step, parameters);
}

void Scheme::energy_state(const State& state, Vector& displacement, Vector& velocity) const {
  displacement = state.displacement;
  velocity = state.velocity;
}

}  // namespace ricochet
