#include "ricochet/fem/wave_speed.hpp"

#include <cmath>

namespace ricochet {

double compression_wave_speed(const Material& material, bool plane_stress) {
  const double branches = material.branch_mu();
  const auto [lambda, mu] =
      IsotropicElasticity::of(material.lambda() - 2.0 / 3.0 * branches, material.mu() + branches, plane_stress);
  return std::sqrt((lambda + 2.0 * mu) / material.density);
}

double shear_wave_speed(const Material& material) {
  return std::sqrt((material.mu() + material.branch_mu()) / material.density);
}

}  // namespace ricochet
