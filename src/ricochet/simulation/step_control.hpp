#pragma once

#include <cstdint>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/step_counts.hpp"

/// @file Steps whose length follows the motion.
namespace ricochet {

struct StepControlOptions {
  double end = 0.0;        ///< the last step ends here, or after it by less than the shortest of them
  double largest = 0.0;    ///< length of a step
  double smallest = 0.0;   ///< below this no step is refused
  double tolerance = 0.0;  ///< relative error of a step, see StepControl
};

/// Lengths are H 2^-k, H the largest, with k up to where they are at most `smallest`: an operator that was factorized
/// serves again. Time is a whole number of the smallest length, so that it has no drift however many steps are taken.
///
/// The error of a step is what schemes of second order leave out of a displacement, e = (h³/12) U⃛, through h and in
/// the norm of the kinetic energy, relative to the largest energy so far,
///   error² = ½(e/h)ᵀM(e/h) / max (kinetic + elastic),   U⃛ ≈ 2(ā − ā₋)/(h+h₋),   ā = (V₁−V₀)/h
/// with the mean acceleration ā₋ of the step before (O. C. Zienkiewicz, Y. M. Xie, Earthquake Engng Struct. Dyn. 20
/// (1991) 871–887, give e for Newmark's scheme). Of a vibration with the part ε² of the energy it is (hω)²ε/12 while
/// steps resolve it, at most about ε/3, and less the less they resolve it; contact nodes without inertia have no part.
///
/// Dofs of supports have no error. But where supports move, the trapezoidal rule gives these dofs velocities that swing
/// from step to step about the true ones, once the motion has had a kink, and through the mass the nodes beside them
/// accelerations that swing as well, which no length of steps makes smaller. They carry no inertial force f = MΔā on
/// the other dofs, so that ½ fᵀD⁻¹f stands for ½ ΔāᵀMΔā there, D the diagonal of M, scaled to the mass (E. Hinton, T.
/// Rock, O. C. Zienkiewicz, Earthquake Engng Struct. Dyn. 4 (1976) 245–249), without the supports.
///
/// If motion sets off from rest the largest energy so far is next to nothing, and no step is short enough beside it:
/// the error of the first step is a fixed part of the motion that this step begins. There the tolerance is relative to
/// the energy that loads, supports and obstacles are about to bring: a quarter of what a look ahead, a step of the
/// longest length that is taken back, ends with, for as long as that step goes. (The trapezoidal rule overshoots a
/// support that sets off by up to the double of its velocity, which is the fourfold of the energy.) It is asked for
/// when a step is refused whose energy is larger than any before.
///
/// A step with a larger error than the tolerance is taken again with a shorter one; where contact begins or ends
/// accelerations jump, so that steps become short there until the change is met. A step with at most half of the
/// allowed error is followed by one twice as long; after refusals growth waits, and the longer the more often it has
/// failed. A step that finds no solution is taken again with a shorter one, too.
class StepControl {
 public:
  static constexpr int most_levels = 40;
  static constexpr double most_ticks = 9e15;  ///< of the smallest length: so many a double counts exactly

  /// Throws Error(invalid_input) where the lengths do not fit together.
  StepControl(const SemidiscreteProblem& problem, const StepControlOptions& options);

  /// Steps that lead less than the longest one further: so many are told, and so many are the end.
  static constexpr long many_steps = 10'000, most_steps = 100'000;

  /// Opens at the state at t = 0.
  void start(const State& state);

  [[nodiscard]] bool at_end() const { return ticks_ >= end_ticks_; }
  /// Tells whether the next step is shorter than it would be without this end.
  [[nodiscard]] bool is_shortened_by_end() const { return !at_end() && level_ > wanted_; }
  [[nodiscard]] double time() const { return static_cast<double>(ticks_) * step_of(deepest_); }
  /// Number k of the length of the next step, and the length itself.
  [[nodiscard]] int level() const { return level_; }
  [[nodiscard]] double step() const { return step_of(level_); }
  [[nodiscard]] double step_of(int level) const;
  [[nodiscard]] int deepest() const { return deepest_; }

  /// Whether the step from `before` to `after` may stay; chooses the length of the next step, or of the next attempt.
  /// `energy`: kinetic and elastic energy after it.
  [[nodiscard]] bool accept(const State& before, const State& after, double energy);
  /// After a step that stays: `energy` again, and what of it the method has created since the start. Throws
  /// Error(not_converged) where that is most of it by far: shorter steps at contact then make a bad scheme worse; and
  /// where steps do not get on.
  void watch(double energy, double created);
  /// After an attempt that must not stay: whether its error is to be compared with the energy that is about to come.
  [[nodiscard]] bool wants_prospect() const { return wants_prospect_; }
  /// A look ahead: the energy after a step of this level from where the attempt began, without what the method has
  /// created in it.
  void take_prospect(int level, double energy);
  /// The step could not be solved: a shorter one. False where there is none.
  [[nodiscard]] bool shorten();

  [[nodiscard]] const StepCounts& counts() const { return counts_; }

  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

 private:
  [[nodiscard]] std::int64_t ticks_of(int level) const { return std::int64_t{1} << (deepest_ - level); }
  void fit_to_end();
  void find_inertia();
  /// ½ of the square of `change_` in the norm of the kinetic energy, of all ranks.
  [[nodiscard]] double energy_of_change();
  [[nodiscard]] double energy_ahead() const { return ticks_ < prospect_ticks_ ? prospect_ : 0.0; }
  void count_step();

  const SemidiscreteProblem& problem_;
  StepControlOptions options_;
  int deepest_ = 0;
  std::int64_t ticks_ = 0, end_ticks_ = 0;
  int level_ = 0;                   ///< of the next step
  int wanted_ = 0;                  ///< the same, but for the end
  int last_level_ = 0;              ///< of the last step that stayed
  int finest_ = 0;                  ///< of the shortest length that errors have asked for
  int patience_ = 0, backoff_ = 2;  ///< steps before lengths may grow again, and after the last refusal
  double largest_energy_ = 0.0, step_before_ = 0.0, error_ = 0.0;
  double own_energy_ = 0.0;  ///< the largest that the method has not created
  double prospect_ = 0.0;    ///< the energy that a look ahead has found, and up to when it counts
  std::int64_t prospect_ticks_ = 0;
  bool wants_prospect_ = false;
  std::int64_t stretch_ticks_ = 0;  ///< where the steps that are counted began
  long stretch_steps_ = 0;
  Vector acceleration_, acceleration_before_, change_;
  Vector inertia_;           ///< D, and 0 at supports and where there is no mass; empty where no support moves
  Vector force_, at_nodes_;  ///< M change_, of this rank and of all
  StepCounts counts_;
};

}  // namespace ricochet
