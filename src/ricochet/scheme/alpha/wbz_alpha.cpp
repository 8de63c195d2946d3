#include "ricochet/scheme/alpha/alpha_scheme.hpp"

namespace ricochet {

/// WBZ-alpha scheme of W. L. Wood, M. Bossak and O. C. Zienkiewicz (Int. J. Numer. Meth. Engng. 15 (1980) 1562–1566):
/// inertia is weighted, forces are not.
SchemeRegistration wbz_alpha_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    const double rho = parameters.number("spectral_radius");
    return std::make_unique<AlphaScheme>(step, AlphaWeights(step, (rho - 1.0) / (rho + 1.0), 0.0));
  };
  return {"wbz-alpha", make, {spectral_radius_key(0.0)}};
}

}  // namespace ricochet
