#pragma once

#include <limits>
#include <optional>

#include "ricochet/io/summary.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file Energy gained or lost by the time discretization, corrections of the velocities, and the reactions that act,
/// over every step, whether or not it has a row in history.csv.
namespace ricochet {

class MethodWatch {
 public:
  /// Watches a scheme with these acting reactions, none if the scheme has no choice, and with corrections of the
  /// velocities if there are any.
  explicit MethodWatch(std::optional<ActingReaction> acting, const Ranks& ranks = one_rank(),
                       bool has_velocity_corrections = false)
      : acting_(acting), ranks_(&ranks) {
    if (has_velocity_corrections) velocity_corrections_.emplace();
  }
  void persist(const SnapshotVisitor& visit);

  /// Enters, before enter_step(), every part of a step that was cut, or the whole step once.
  void enter_part(const StepCorrections& corrections);
  /// Enters a step with EnergyAccount::method_energy at its end. Allocates nothing.
  void enter_step(const State& state, double method_energy);
  /// Returns the energies relative to the largest energy.
  [[nodiscard]] MethodEnergy energy(double largest_energy) const;
  [[nodiscard]] std::optional<ActingReactions> reactions() const;
  [[nodiscard]] const std::optional<VelocityCorrections>& velocity_corrections() const { return velocity_corrections_; }

 private:
  void enter_weight(const StepForces& forces);
  void enter_velocity_correction(double time);

  std::optional<ActingReaction> acting_;
  const Ranks* ranks_;
  double least_ = 0.0, largest_ = 0.0, last_ = 0.0;  ///< of the energy that the method has added
  double least_weight_ = std::numeric_limits<double>::infinity(), largest_weight_ = -least_weight_;
  long mean_steps_ = 0, end_steps_ = 0;
  std::optional<VelocityCorrections> velocity_corrections_;
  double corrected_share_ = 0.0;  ///< of the energy, in the parts of the present step
  double largest_energy_ = 0.0;   ///< kinetic and elastic
};

}  // namespace ricochet
