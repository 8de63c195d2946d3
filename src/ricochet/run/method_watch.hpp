#pragma once

#include <limits>
#include <optional>

#include "ricochet/io/summary.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file Energy gained or lost by the time discretization, and the reactions that act, over every step, whether or not
/// it has a row in history.csv.
namespace ricochet {

class MethodWatch {
 public:
  /// Watches a scheme with these acting reactions; none if the scheme has no choice.
  explicit MethodWatch(std::optional<ActingReaction> acting, const Ranks& ranks = one_rank())
      : acting_(acting), ranks_(&ranks) {}
  void persist(const SnapshotVisitor& visit);

  /// Enters a step with EnergyAccount::method_energy at its end. Allocates nothing.
  void enter_step(const State& state, double method_energy);
  /// Returns the energies relative to the largest energy.
  [[nodiscard]] MethodEnergy energy(double largest_energy) const;
  [[nodiscard]] std::optional<ActingReactions> reactions() const;

 private:
  void enter_weight(const StepForces& forces);

  std::optional<ActingReaction> acting_;
  const Ranks* ranks_;
  double least_ = 0.0, largest_ = 0.0, last_ = 0.0;  ///< of the energy that the method has added
  double least_weight_ = std::numeric_limits<double>::infinity(), largest_weight_ = -least_weight_;
  long mean_steps_ = 0, end_steps_ = 0;
};

}  // namespace ricochet
