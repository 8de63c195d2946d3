#include "ricochet/fem/wave_speed.hpp"

#include <cmath>

namespace ricochet {

double compression_wave_speed(const Material& material, bool plane_stress) {
  const double lambda = plane_stress ? material.plane_stress_lambda() : material.lambda();
  return std::sqrt((lambda + 2.0 * material.mu()) / material.density);
}

double shear_wave_speed(const Material& material) {
  return std::sqrt(material.mu() / material.density);
}

}  // namespace ricochet
