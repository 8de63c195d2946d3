#pragma once

#include <algorithm>

#include "ricochet/base/types.hpp"
#include "ricochet/step/thresholds.hpp"

/// @file Renewal of a factor that is kept over steps.
namespace ricochet {

/// A step with contact forces that takes n iterations owes n − n₀ − 1 of them to the age of the factor, with n₀ the
/// least number of such a step since the factor was made. (Numbers vary by one without reason.) The factor is renewed
/// when this debt has grown to a few times the price of a new one, so that the choice costs at most a constant factor
/// more than the best one (ski rental), and depends on counts alone: runs have the same bits on every machine. Steps in
/// flight have no debt: the last factor serves all of them.
class FactorDebt {
 public:
  /// Keeps a reference to its numbers, which belong to the state of a run; at first they are zero.
  explicit FactorDebt(Eigen::Ref<Vector> memory) : memory_(memory) {}
  static constexpr Index numbers = 2;

  /// `price`: number of iterations that take as long as a new factor.
  [[nodiscard]] bool is_due(double price) const { return memory_[0] >= NewtonThresholds().debt_in_prices * price; }
  void clear() { memory_.head(numbers).setZero(); }
  void add_step(int iterations) {
    double& least = memory_[1];
    least = least > 0.0 ? std::min(least, double(iterations)) : double(iterations);
    memory_[0] += std::max(double(iterations) - least - 1.0, 0.0);
  }

 private:
  Eigen::Ref<Vector> memory_;
};

}  // namespace ricochet
