#include "ricochet/scheme/alpha/alpha_scheme.hpp"

namespace ricochet {

/// Generalized-alpha scheme of J. Chung and G. M. Hulbert (J. Appl. Mech. 60 (1993) 371–375): of all weights with this
/// spectral radius, those that damp low frequencies least.
SchemeRegistration generalized_alpha_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<AlphaScheme>(step, generalized_alpha_weights(step, parameters.number("spectral_radius")));
  };
  return {"generalized-alpha", make, {spectral_radius_key(0.0)}};
}

}  // namespace ricochet
