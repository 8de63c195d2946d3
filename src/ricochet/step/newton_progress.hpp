#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/step/thresholds.hpp"

/// @file Convergence monitor of Newton iterations with a factorization that is reused.
namespace ricochet {

/// Corrections d₁, d₂, … that decrease at a rate θ leave an error of about |d_k| θ/(1−θ). The iterations end when this
/// is below a fraction of the increment sought, or when a correction is at the rounding level of the positions; they
/// request a new factorization when θ implies that many more iterations would be needed.
class NewtonProgress {
 public:
  enum class Advice { go_on, done, renew, failed };
  explicit NewtonProgress(const NewtonThresholds& thresholds = {}) : thresholds_(thresholds) {}

  /// Begins a solution; `rounding`: rounding error of the positions, the smallest meaningful correction.
  void start(double rounding) {
    rounding_ = rounding;
    renewals_ = total_iterations_ = 0;
    accelerates_ = false;
    restart();
  }
  /// Resets the rates after a new factorization.
  void restart() {
    iterations_ = 0;
    last_ = least_ = std::numeric_limits<double>::infinity();
    slow_ = growing_ = 0;
  }
  /// Assesses an iteration by the largest entries of its correction and of the increment so far.
  Advice judge(double correction, double increment) {
    ++iterations_;
    ++total_iterations_;
    if (!std::isfinite(correction)) return renew_or_fail();
    if (correction <= rounding_) return Advice::done;
    if (iterations_ == 1) {
      last_ = least_ = correction;
      return Advice::go_on;
    }
    const double rate = correction / last_;
    const double left = rate < 1.0 ? correction * rate / (1.0 - rate) : correction;
    if (rate < 1.0 && left <= thresholds_.tolerance * increment) return Advice::done;
    // The accumulated rounding of the forces may exceed that of the positions: further iterations gain nothing.
    if (rate >= thresholds_.stalled &&
        correction <= std::max(thresholds_.loose_tolerance * increment, thresholds_.most_rounding * rounding_))
      return Advice::done;
    last_ = correction;
    slow_ = rate > thresholds_.slow_rate ? slow_ + 1 : 0;
    growing_ = rate > 1.0 ? growing_ + 1 : 0;
    least_ = std::min(least_, correction);
    const bool diverges = correction > thresholds_.divergence * least_;
    accelerates_ =
        accelerates_ || growing_ >= thresholds_.most_growing || (slow_ >= thresholds_.patience && renewals_ > 0);
    // If earlier factorizations did not help, another one does not either, and iterations
    // that still converge may continue.
    const bool is_worth_one = slow_ >= (accelerates_ ? thresholds_.long_patience : thresholds_.patience) &&
                              renewals_ < thresholds_.helpful_renewals;
    if (is_worth_one || diverges || iterations_ >= thresholds_.max_iterations) return renew_or_fail();
    return Advice::go_on;
  }
  void count_renewal() { ++renewals_; }
  /// Whether the corrections grow, or decrease slowly even with a new factorization, because some forces are missing
  /// from it (those of contact rotate with the surface they act on): iterations may then be accelerated
  /// (linear_algebra/anderson_acceleration.hpp).
  [[nodiscard]] bool wants_acceleration() const { return accelerates_; }
  [[nodiscard]] Error failure(double correction) const;
  [[nodiscard]] int iterations() const { return total_iterations_; }

 private:
  [[nodiscard]] Advice renew_or_fail() const {
    return renewals_ < thresholds_.most_renewals ? Advice::renew : Advice::failed;
  }

  NewtonThresholds thresholds_;
  double rounding_ = 0.0, last_ = 0.0, least_ = 0.0;
  int iterations_ = 0, total_iterations_ = 0, slow_ = 0, growing_ = 0, renewals_ = 0;
  bool accelerates_ = false;
};

}  // namespace ricochet
