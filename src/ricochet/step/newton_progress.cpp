#include "ricochet/step/newton_progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/log.hpp"

namespace ricochet {

void NewtonProgress::start(double rounding, double renewal_price, double tolerance) {
  rounding_ = rounding;
  tolerance_ = tolerance;
  renewal_price_ = renewal_price;
  renewals_ = total_iterations_ = 0;
  accelerates_ = decreases_near_ = false;
  restart();
}

void NewtonProgress::restart() {
  iterations_ = 0;
  least_ = std::numeric_limits<double>::infinity();
  recent_.fill(0.0);
  slow_ = growing_ = 0;
}

NewtonProgress::Advice NewtonProgress::assess(double correction, double increment) {
  ++iterations_;
  ++total_iterations_;
  if (log::enabled(log::Level::debug)) {
    log::debug(fmt::format("Newton: iteration {}, correction {:.2e} of {:.2e}{}", total_iterations_, correction,
                           increment, wants_acceleration() ? ", accelerated" : ""));
  }
  if (!std::isfinite(correction)) return renew_or_fail();
  if (correction <= rounding_) return Advice::done;
  std::shift_right(recent_.begin(), recent_.end(), 1);
  recent_[0] = correction;
  if (iterations_ == 1) {
    least_ = correction;
    return Advice::proceed;
  }
  const double rate = correction / recent_[1];
  const double left = rate < 1.0 ? correction * rate / (1.0 - rate) : correction;
  if (rate < 1.0 && left <= tolerance_ * increment) return Advice::done;
  // The accumulated rounding of the forces may exceed that of the positions: further iterations gain nothing.
  if (rate >= thresholds_.stalled_rate &&
      correction <= std::max(thresholds_.loose_tolerance * increment, thresholds_.max_rounding * rounding_))
    return Advice::done;
  decreases_near_ = rate < 1.0 && correction <= thresholds_.near * increment;
  slow_ = rate > thresholds_.slow_rate ? slow_ + 1 : 0;
  growing_ = rate > 1.0 ? growing_ + 1 : 0;
  least_ = std::min(least_, correction);
  const bool diverges = correction > thresholds_.divergence * least_;
  accelerates_ = accelerates_ || growing_ >= thresholds_.max_growing ||
                 (slow_ >= thresholds_.max_slow && renewals_ > 0) || total_iterations_ > thresholds_.plain_iterations;
  if (renewal_pays(increment) || diverges || iterations_ >= thresholds_.max_iterations) return renew_or_fail();
  return Advice::proceed;
}

/// Compares the iterations that are left at the mean rate of the last three with those after a new factorization. If
/// earlier factorizations did not help, another one does not either, and iterations that still converge may continue.
bool NewtonProgress::renewal_pays(double increment) const {
  if (!(recent_.back() > 0.0) || renewals_ >= thresholds_.helpful_renewals) return false;
  const double left = std::log(recent_[0] / (tolerance_ * increment));
  return expected_iterations(increment) - left / -std::log(thresholds_.renewed_rate) > renewal_price_;
}

double NewtonProgress::expected_iterations(double increment) const {
  const double most = thresholds_.max_iterations;
  if (!(recent_.back() > 0.0)) return most;
  const double rate = std::cbrt(recent_[0] / recent_.back());
  const double left = std::log(recent_[0] / (tolerance_ * increment));
  return rate < 1.0 ? std::min(left / -std::log(rate), most) : most;
}

Error NewtonProgress::failure(double correction) const {
  return {ErrorKind::not_converged,
          fmt::format("Newton's method did not converge in {} iterations (the last correction moves a node by {:.3g})",
                      total_iterations_, correction)};
}

}  // namespace ricochet
