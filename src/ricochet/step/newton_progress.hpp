#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/types.hpp"

/// @file Convergence monitor of Newton iterations with a factorization that is reused.
namespace ricochet {

/// Corrections d₁, d₂, … that decrease at a rate θ leave an error of about |d_k| θ/(1−θ). The iterations end when this
/// is below a fraction of the increment sought, or when a correction is at the rounding level of the positions; they
/// request a new factorization when θ implies that many more iterations would be needed.
class NewtonProgress {
 public:
  enum class Advice { go_on, done, renew, failed };

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
    if (rate < 1.0 && left <= tolerance * increment) return Advice::done;
    // The accumulated rounding of the forces may exceed that of the positions: further iterations gain nothing.
    if (rate >= stalled && correction <= std::max(loose_tolerance * increment, most_rounding * rounding_))
      return Advice::done;
    last_ = correction;
    slow_ = rate > slow_rate ? slow_ + 1 : 0;
    growing_ = rate > 1.0 ? growing_ + 1 : 0;
    least_ = std::min(least_, correction);
    const bool diverges = correction > divergence * least_;
    accelerates_ = accelerates_ || growing_ >= most_growing || (slow_ >= patience && renewals_ > 0);
    // If earlier factorizations did not help, another one does not either, and iterations
    // that still converge may continue.
    const bool is_worth_one = slow_ >= (accelerates_ ? long_patience : patience) && renewals_ < helpful_renewals;
    if (is_worth_one || diverges || iterations_ >= max_iterations) return renew_or_fail();
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
  static constexpr double tolerance = 1e-13;       ///< relative to the increment
  static constexpr double loose_tolerance = 1e-9;  ///< if rounding keeps the corrections from decreasing further
  static constexpr double most_rounding = 100.0;   ///< relative to that of the positions, in the same situation
  static constexpr double stalled = 0.7;
  static constexpr double slow_rate = 0.5;
  static constexpr double divergence = 1e3;
  static constexpr int most_growing = 2, patience = 3, long_patience = 15, max_iterations = 60, helpful_renewals = 3,
                       most_renewals = 6;

  [[nodiscard]] Advice renew_or_fail() const { return renewals_ < most_renewals ? Advice::renew : Advice::failed; }

  double rounding_ = 0.0, last_ = 0.0, least_ = 0.0;
  int iterations_ = 0, total_iterations_ = 0, slow_ = 0, growing_ = 0, renewals_ = 0;
  bool accelerates_ = false;
};

}  // namespace ricochet
