#include "ricochet/scheme/reduced/energy_secant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

/// Upper bound of |σ|, which is about half of the change of a strain; larger values mean that steps are far too long.
constexpr double largest_sigma = 1.0;
/// Admissible slopes dσ_required/dσ of a secant; those from `weak` on are weak.
constexpr double steepest = 4.0, weak = 0.8, min_complement = 0.002, min_complement_settled = 1e-6;
/// Iterations in which displacements settle.
constexpr int settling_iterations = 3;

void EnergySecant::start() {
  sigma_ = 0.0;
  sigma_before_ = required_before_ = slope_ = std::numeric_limits<double>::quiet_NaN();
  is_weak_ = false;
  settling_ = stalled_changes_ = 0;
  smallest_defect_ = std::numeric_limits<double>::infinity();
}

bool EnergySecant::choose(double required, double defect, double near_rounding, bool has_converged) {
  if (is_settled()) return false;
  if (is_weak_ && !has_converged && ++settling_ < settling_iterations) return false;
  settling_ = 0;
  if (std::abs(defect) > near_rounding) slope_ = (required - required_before_) / (sigma_ - sigma_before_);
  double next = required;
  if (std::isfinite(slope_) && slope_ > -steepest &&
      slope_ < 1.0 - (is_weak_ ? min_complement_settled : min_complement))
    next = (required - slope_ * sigma_) / (1.0 - slope_);
  if (is_weak_) stalled_changes_ = std::abs(defect) > 0.5 * smallest_defect_ ? stalled_changes_ + 1 : 0;
  smallest_defect_ = std::min(smallest_defect_, std::abs(defect));
  is_weak_ = is_weak_ || (std::isfinite(slope_) && slope_ > weak);
  sigma_before_ = sigma_;
  required_before_ = required;
  sigma_ = std::clamp(next, -largest_sigma, largest_sigma);
  return is_weak_;
}

}  // namespace ricochet
