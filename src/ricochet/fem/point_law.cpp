#include "ricochet/fem/point_law.hpp"

#include <cmath>
#include <limits>

#include "ricochet/fem/finite_strain.hpp"

namespace ricochet {

Tensor PointLaw::strain(const Tensor& gradient) const {
  Tensor strain;
  if (is_linear_) {
    strain = 0.5 * (gradient + gradient.transpose());
  } else {
    strain = green_strain(gradient);
  }
  complete(strain);
  return strain;
}

/// Newton's method for S_zz(E_zz) = 0, from the strain of linear elasticity. The stress increases with the strain; if a
/// step would invert the volume (E_zz ≤ −½), it is replaced by half of the distance to that bound.
void PointLaw::solve_plane_stress(Tensor& strain) const {
  constexpr int most_steps = 60;
  const double lambda = law_->lambda(), mu = law_->mu();
  double& across = strain(2, 2);
  across = -lambda / (lambda + 2.0 * mu) * (strain(0, 0) + strain(1, 1));
  if (is_linear_) return;
  if (across <= -0.5) across = -0.25;
  Tensor stress;
  StressTangent tangent;
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < most_steps; ++step) {
    law_->stress(strain, stress);
    law_->tangent(strain, tangent);
    const double change = -stress(2, 2) / tangent(2, 2);
    if (!std::isfinite(change)) break;
    const double next = across + change;
    across = next > -0.5 ? next : 0.5 * (across - 0.5);
    // Newton's method has reached full precision once the changes no longer decrease, or a change is at the
    // rounding level of the strains.
    const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * strain.cwiseAbs().maxCoeff();
    if (std::abs(change) <= rounding || (std::abs(change) < 1e-8 && std::abs(change) >= last)) return;
    last = std::abs(change);
  }
  // Changes below all digits, as for a body at rest.
  if (last < std::numeric_limits<double>::epsilon()) return;
  across = std::numeric_limits<double>::quiet_NaN();
}

void PointLaw::tangent(const Tensor& strain, StressTangent& result) const {
  law_->tangent(strain, result);
  if (!plane_stress_) return;
  const Eigen::Matrix<double, 6, 1> across = result.col(2);
  result.noalias() -= across * (across.transpose() / across[2]);
  result.row(2).setZero();
  result.col(2).setZero();
}

}  // namespace ricochet
