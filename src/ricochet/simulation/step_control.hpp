#pragma once

#include <cstdint>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/step_counts.hpp"

/// @file Adaptive step lengths.
namespace ricochet {

struct StepControlOptions {
  double end = 0.0;        ///< the last step ends here, or later by less than the shortest step
  double largest = 0.0;    ///< length of a step
  double smallest = 0.0;   ///< below this length no step is refused
  double tolerance = 0.0;  ///< relative error of a step, see StepControl
};

/// Step lengths are H 2^-k, H the largest, with k up to the first length that is at most `smallest`, so that factorized
/// operators are reused. Time is a whole number of the smallest length and therefore has no drift, however many steps
/// are taken.
///
/// The error of a step is the term that schemes of second order neglect in a displacement, e = (h³/12) U⃛, divided by h
/// and measured in the norm of the kinetic energy relative to the largest energy so far,
///   error² = ½(e/h)ᵀM(e/h) / max (kinetic + elastic),   U⃛ ≈ 2(ā − ā₋)/(h+h₋),   ā = (V₁−V₀)/h
/// with the mean acceleration ā₋ of the previous step (O. C. Zienkiewicz, Y. M. Xie, Earthquake Engng Struct. Dyn. 20
/// (1991) 871–887, derive e for Newmark's scheme). A vibration with the fraction ε² of the energy has the error
/// (hω)²ε/12 while steps resolve it, at most about ε/3, and a smaller one the less they resolve it; massless contact
/// nodes do not contribute.
///
/// Supported dofs have no error. But if supports move, the trapezoidal rule gives these dofs velocities that oscillate
/// from step to step about the true ones after a kink of the motion, and through the mass matrix the adjacent nodes get
/// accelerations that oscillate as well; shorter steps do not reduce this. They exert no inertial force f = MΔā on the
/// other dofs, so that ½ fᵀD⁻¹f without the supported dofs replaces ½ ΔāᵀMΔā, where D is the diagonal of M scaled to
/// the total mass (E. Hinton, T. Rock, O. C. Zienkiewicz, Earthquake Engng Struct. Dyn. 4 (1976) 245–249).
///
/// If motion starts from rest, the largest energy so far is almost zero and no step is short enough relative to it: the
/// error of the first step is a fixed fraction of the motion that begins in it. The tolerance is then relative to the
/// energy that loads, supports and obstacles are about to bring in: a quarter of the energy at the end of a trial step
/// of the longest length, for the duration of that step. (The trapezoidal rule overshoots the velocity of a support
/// that starts to move by up to a factor of two, which is a factor of four in energy.) The trial step, which is undone
/// afterwards, is requested when a step is refused whose energy exceeds all earlier ones.
///
/// A step whose error exceeds the tolerance is repeated with a shorter length; accelerations jump when contact begins
/// or ends, so that steps become short there until the change is resolved. A step with at most half of the allowed
/// error is followed by one of twice the length; after refusals growth is delayed, and longer the more often it has
/// failed. A step without a solution is also repeated with a shorter length.
class StepControl {
 public:
  static constexpr int most_levels = 40;
  static constexpr double most_ticks = 9e15;  ///< smallest lengths in a run: double counts up to there exactly

  /// Throws Error(invalid_input) if the lengths are inconsistent.
  StepControl(const SemidiscreteProblem& problem, const StepControlOptions& options);

  /// Numbers of consecutive steps within the longest length at which a warning is logged and the run ends.
  static constexpr long many_steps = 10'000, most_steps = 100'000;

  /// Starts at the state at t = 0.
  void start(const State& state);

  [[nodiscard]] bool at_end() const { return ticks_ >= end_ticks_; }
  /// Returns whether the next step is shorter only because the run ends.
  [[nodiscard]] bool is_shortened_by_end() const { return !at_end() && level_ > required_level_; }
  [[nodiscard]] double time() const { return double(ticks_) * step_of(deepest_); }
  /// Level k of the next step, and its length.
  [[nodiscard]] int level() const { return level_; }
  [[nodiscard]] double step() const { return step_of(level_); }
  [[nodiscard]] double step_of(int level) const;
  [[nodiscard]] int deepest() const { return deepest_; }

  /// Returns whether the step from `before` to `after` is accepted; chooses the length of the next step, or of the next
  /// attempt. `energy`: kinetic and elastic energy at `after`.
  [[nodiscard]] bool accept(const State& before, const State& after, double energy);
  /// Checks an accepted step: `energy` as above, and the part of it that the method has created since the start. Throws
  /// Error(not_converged) if the created part is by far the largest, since shorter steps at contact then aggravate the
  /// instability of the scheme, and if the steps hardly advance the time.
  void watch(double energy, double created);
  /// Returns whether, after a refused attempt, its error is to be compared with the energy that is about to come.
  [[nodiscard]] bool needs_trial_step() const { return needs_trial_step_; }
  /// Accepts the result of a trial step of this level from the start of the attempt: the energy at its end, without the
  /// energy that the method has created in it.
  void set_energy_ahead(int level, double energy);
  /// Shortens a step that has no solution. Returns false if it already has the shortest length.
  [[nodiscard]] bool shorten();

  [[nodiscard]] const StepCounts& counts() const { return counts_; }

  void persist(const SnapshotVisitor& visit);

 private:
  [[nodiscard]] std::int64_t ticks_of(int level) const { return std::int64_t{1} << (deepest_ - level); }
  void fit_to_end();
  void find_inertia();
  /// Half of the square of `change_` in the norm of the kinetic energy, over all ranks.
  [[nodiscard]] double energy_of_change();
  [[nodiscard]] double energy_ahead() const { return ticks_ < energy_ahead_ticks_ ? energy_ahead_ : 0.0; }
  void count_step();

  const SemidiscreteProblem& problem_;
  StepControlOptions options_;
  int deepest_ = 0;
  std::int64_t ticks_ = 0, end_ticks_ = 0;
  int level_ = 0;                   ///< of the next step
  int required_level_ = 0;          ///< likewise, before it is fitted to the end
  int last_level_ = 0;              ///< of the last accepted step
  int finest_ = 0;                  ///< level of the shortest length required so far
  int patience_ = 0, backoff_ = 2;  ///< steps until lengths may grow again: left, and after the last refusal
  double largest_energy_ = 0.0, step_before_ = 0.0, error_ = 0.0;
  double own_energy_ = 0.0;    ///< largest energy without the part that the method has created
  double energy_ahead_ = 0.0;  ///< energy that the trial step has found, and the time until which it counts
  std::int64_t energy_ahead_ticks_ = 0;
  bool needs_trial_step_ = false;
  std::int64_t stretch_ticks_ = 0;  ///< start of the steps that are counted
  long stretch_steps_ = 0;
  Vector acceleration_, acceleration_before_, change_;
  Vector inertia_;           ///< D, but 0 at supported and massless dofs; empty if no support moves
  Vector force_, at_nodes_;  ///< M change_, of this rank and summed over ranks
  StepCounts counts_;
};

}  // namespace ricochet
