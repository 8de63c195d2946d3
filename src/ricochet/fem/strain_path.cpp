#include "ricochet/fem/strain_path.hpp"

#include <cmath>

namespace ricochet {

/// Roots of Legendre's polynomials of degree 2, 3 and 5, in closed form.
const std::array<PathGaussRule, 3>& path_gauss_rules() {
  static const std::array<PathGaussRule, 3> rules = [] {
    const double two = 0.5 / std::sqrt(3.0), three = 0.5 * std::sqrt(0.6);
    const double root = 2.0 * std::sqrt(10.0 / 7.0);
    const double inner = std::sqrt(5.0 - root) / 6.0, outer = std::sqrt(5.0 + root) / 6.0;
    const double part = 13.0 * std::sqrt(70.0);
    return std::array<PathGaussRule, 3>{{{2, {-two, two}, {0.5, 0.5}},
                                         {3, {-three, 0.0, three}, {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0}},
                                         {5,
                                          {-outer, -inner, 0.0, inner, outer},
                                          {(322.0 - part) / 1800.0, (322.0 + part) / 1800.0, 64.0 / 225.0,
                                           (322.0 + part) / 1800.0, (322.0 - part) / 1800.0}}}};
  }();
  return rules;
}

}  // namespace ricochet
