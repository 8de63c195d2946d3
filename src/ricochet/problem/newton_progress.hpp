#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/types.hpp"

/// @file Whether iterations with a factor that is kept come near, and near enough.
namespace ricochet {

/// Corrections d₁, d₂, … that shrink by a rate θ leave an error of about |d_k| θ/(1−θ). Iterations end where that is
/// less than a part of the increment sought, or where a correction is the rounding of the positions; they ask for a
/// new factor where θ says that many more would be needed.
class NewtonProgress {
 public:
  enum class Advice { go_on, done, renew, failed };

  /// `rounding`: of positions, the least correction that means something.
  void start(double rounding) {
    rounding_ = rounding;
    renewals_ = all_rounds_ = 0;
    accelerates_ = false;
    restart();
  }
  /// After a new factor.
  void restart() {
    rounds_ = 0;
    last_ = least_ = std::numeric_limits<double>::infinity();
    slow_ = growing_ = 0;
  }
  /// With the largest entry of a correction and that of the increment so far.
  Advice judge(double correction, double increment) {
    ++rounds_;
    ++all_rounds_;
    if (!std::isfinite(correction)) return renew_or_fail();
    if (correction <= rounding_) return Advice::done;
    if (rounds_ == 1) {
      last_ = least_ = correction;
      return Advice::go_on;
    }
    const double rate = correction / last_;
    const double left = rate < 1.0 ? correction * rate / (1.0 - rate) : correction;
    if (rate < 1.0 && left <= tolerance * increment) return Advice::done;
    // Rounding that accumulates in forces may be larger than that of positions: nothing is gained any more.
    if (rate >= stalled && correction <= std::max(loose_tolerance * increment, most_rounding * rounding_))
      return Advice::done;
    last_ = correction;
    slow_ = rate > slow_rate ? slow_ + 1 : 0;
    growing_ = rate > 1.0 ? growing_ + 1 : 0;
    least_ = std::min(least_, correction);
    const bool diverges = correction > divergence * least_;
    accelerates_ = accelerates_ || growing_ >= most_growing || (slow_ >= patience && renewals_ > 0);
    // New factors that brought nothing before bring nothing now, and what comes nearer may go on.
    const bool is_worth_one = slow_ >= (accelerates_ ? long_patience : patience) && renewals_ < helpful_renewals;
    if (is_worth_one || diverges || rounds_ >= most_rounds) return renew_or_fail();
    return Advice::go_on;
  }
  void count_renewal() { ++renewals_; }
  /// Corrections grow, or shrink slowly with a new factor, as some forces are in none (those of contact turn with what
  /// they press on): iterations may be accelerated (linear_algebra/anderson_acceleration.hpp).
  [[nodiscard]] bool wants_acceleration() const { return accelerates_; }
  [[nodiscard]] Error failure(double correction) const;
  [[nodiscard]] int rounds() const { return all_rounds_; }

 private:
  static constexpr double tolerance = 1e-13;       ///< of the increment
  static constexpr double loose_tolerance = 1e-9;  ///< where rounding lets corrections shrink no more
  static constexpr double most_rounding = 100.0;   ///< times that of positions, likewise
  static constexpr double stalled = 0.7;
  static constexpr double slow_rate = 0.5;
  static constexpr double divergence = 1e3;
  static constexpr int most_growing = 2, patience = 3, long_patience = 15, most_rounds = 60, helpful_renewals = 3,
                       most_renewals = 6;

  [[nodiscard]] Advice renew_or_fail() const { return renewals_ < most_renewals ? Advice::renew : Advice::failed; }

  double rounding_ = 0.0, last_ = 0.0, least_ = 0.0;
  int rounds_ = 0, all_rounds_ = 0, slow_ = 0, growing_ = 0, renewals_ = 0;
  bool accelerates_ = false;
};

}  // namespace ricochet
