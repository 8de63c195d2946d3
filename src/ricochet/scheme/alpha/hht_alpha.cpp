#include "ricochet/scheme/alpha/alpha_scheme.hpp"

namespace ricochet {

/// HHT-alpha scheme of H. M. Hilber, T. J. R. Hughes and R. L. Taylor (Earthquake Engng Struct. Dyn. 5 (1977) 283–292):
/// forces are weighted, inertia is not; their alpha is −α_f.
SchemeRegistration hht_alpha_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    const double rho = parameters.number("spectral_radius");
    return std::make_unique<AlphaScheme>(step, AlphaWeights(step, 0.0, (1.0 - rho) / (1.0 + rho)));
  };
  return {"hht-alpha", make, {spectral_radius_key(0.5)}};
}

}  // namespace ricochet
