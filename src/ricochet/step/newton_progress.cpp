#include "ricochet/step/newton_progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

void NewtonProgress::start(double rounding, double tolerance) {
  rounding_ = rounding;
  tolerance_ = tolerance;
  renewals_ = total_iterations_ = 0;
  accelerates_ = false;
  restart();
}

bool NewtonProgress::tighten() {
  if (tolerance_ <= thresholds_.least_tolerance) return false;
  tolerance_ = thresholds_.least_tolerance;
  return true;
}

void NewtonProgress::restart() {
  iterations_ = 0;
  last_ = least_ = std::numeric_limits<double>::infinity();
  slow_ = growing_ = 0;
}

NewtonProgress::Advice NewtonProgress::assess(double correction, double increment) {
  ++iterations_;
  ++total_iterations_;
  if (!std::isfinite(correction)) return renew_or_fail();
  if (correction <= rounding_) return Advice::done;
  if (iterations_ == 1) {
    last_ = least_ = correction;
    return Advice::proceed;
  }
  const double rate = correction / last_;
  const double left = rate < 1.0 ? correction * rate / (1.0 - rate) : correction;
  if (rate < 1.0 && left <= tolerance_ * increment) return Advice::done;
  // The accumulated rounding of the forces may exceed that of the positions: further iterations gain nothing.
  if (rate >= thresholds_.stalled_rate &&
      correction <= std::max(thresholds_.loose_tolerance * increment, thresholds_.max_rounding * rounding_))
    return Advice::done;
  last_ = correction;
  slow_ = rate > thresholds_.slow_rate ? slow_ + 1 : 0;
  growing_ = rate > 1.0 ? growing_ + 1 : 0;
  least_ = std::min(least_, correction);
  const bool diverges = correction > thresholds_.divergence * least_;
  accelerates_ =
      accelerates_ || growing_ >= thresholds_.max_growing || (slow_ >= thresholds_.max_slow && renewals_ > 0);
  // If earlier factorizations did not help, another one does not either, and iterations that still converge may
  // continue.
  const bool is_worth_one = slow_ >= (accelerates_ ? thresholds_.max_slow_accelerated : thresholds_.max_slow) &&
                            renewals_ < thresholds_.helpful_renewals;
  if (is_worth_one || diverges || iterations_ >= thresholds_.max_iterations) return renew_or_fail();
  return Advice::proceed;
}

Error NewtonProgress::failure(double correction) const {
  return {ErrorKind::not_converged,
          fmt::format("Newton's method did not converge in {} iterations (the last correction moves a node by {:.3g})",
                      total_iterations_, correction)};
}

}  // namespace ricochet
