#pragma once

#include <algorithm>
#include <array>

#include "ricochet/base/error.hpp"
#include "ricochet/step/thresholds.hpp"

/// @file Convergence monitor of Newton iterations with a factorization that is reused.
namespace ricochet {

/// Corrections d₁, d₂, … that decrease at a rate θ leave an error of about |d_k| θ/(1−θ). The iterations end when this
/// is below a fraction of the increment sought, or when a correction is at the rounding level of the positions. They
/// request a new factorization if it takes less time than the iterations that it saves: those needed at the rate θ,
/// less those at the rate that is usual after a new factorization.
class NewtonProgress {
 public:
  enum class Advice {
    proceed,  ///< iterate with the same factorization
    done,     ///< the iterations have converged
    renew,    ///< make a new factorization, then call count_renewal() and restart()
    failed,   ///< throw failure()
  };
  explicit NewtonProgress(const NewtonThresholds& thresholds = {}) : thresholds_(thresholds) {}

  /// Begins a solution; `rounding`: rounding error of the positions, the smallest meaningful correction;
  /// `renewal_price`: number of iterations that take as long as a new factorization (StageSolve); `tolerance`: of the
  /// error that is left, relative to the increment.
  void start(double rounding, double renewal_price, double tolerance);
  /// Begins a solution as accurate as rounding permits.
  void start(double rounding, double renewal_price) { start(rounding, renewal_price, thresholds_.least_tolerance); }
  /// Resets the rates after a new factorization.
  void restart();
  /// Assesses an iteration by the sizes of its correction and of the increment so far, in the same norm: lengths. With
  /// several ranks both must be those of the whole body, or the ranks would follow different advice.
  Advice assess(double correction, double increment);
  void count_renewal() { ++renewals_; }
  /// Requires the accuracy that rounding permits from now on, until the next start().
  void tighten() { tolerance_ = std::min(tolerance_, thresholds_.least_tolerance); }
  [[nodiscard]] bool is_tight() const { return tolerance_ <= thresholds_.least_tolerance; }
  /// Whether the next iteration may be accelerated (linear_algebra/qr_anderson_acceleration.hpp): corrections decrease
  /// and are small relative to the increment, or they grow, or decrease slowly even with a new factorization. (The
  /// reason of the latter is a force that no factorization contains, such as that of contact, which rotates with the
  /// surface on which it acts.) Far from a solution, accelerated iterations may lead to another one.
  [[nodiscard]] bool wants_acceleration() const { return accelerates_ || decreases_near_; }
  /// Number of iterations that are left at the mean rate of the last ones, up to max_iterations; this if there are too
  /// few of them. `increment`: as in assess().
  [[nodiscard]] double expected_iterations(double increment) const;
  [[nodiscard]] Error failure(double correction) const;
  /// Least correction since the last factorization.
  [[nodiscard]] double least_correction() const { return least_; }
  [[nodiscard]] int iterations() const { return total_iterations_; }
  [[nodiscard]] int renewals() const { return renewals_; }

 private:
  [[nodiscard]] Advice renew_or_fail() const {
    return renewals_ < thresholds_.max_renewals ? Advice::renew : Advice::failed;
  }
  [[nodiscard]] bool renewal_pays(double increment) const;

  NewtonThresholds thresholds_;
  double rounding_ = 0.0, renewal_price_ = 0.0, tolerance_ = 0.0;  ///< of this solution
  std::array<double, 4> recent_{};                                 ///< last corrections, newest first; 0: none
  double least_ = 0.0;
  int iterations_ = 0, total_iterations_ = 0, slow_ = 0, growing_ = 0, renewals_ = 0;
  bool accelerates_ = false, decreases_near_ = false;
};

}  // namespace ricochet
