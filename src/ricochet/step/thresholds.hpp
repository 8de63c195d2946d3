#pragma once

/// @file Thresholds of the iterations of a step. They were chosen on thousands of random cases: another value changes
/// results in their last digits, and how many iterations, cut steps and failures there are.
namespace ricochet {

/// Thresholds of Newton iterations with a factorization that is reused (newton_progress.hpp).
struct NewtonThresholds {
  double tolerance = 1e-13;       ///< of the remaining error, relative to the increment
  double loose_tolerance = 1e-9;  ///< the same if rounding keeps the corrections from decreasing further
  double most_rounding = 100.0;   ///< relative to that of the positions, in the same situation
  double stalled = 0.7;           ///< rate above which rounding may be the reason
  double slow_rate = 0.5;
  int patience = 3;          ///< slow iterations before a new factorization
  int long_patience = 15;    ///< the same if earlier ones did not help
  double divergence = 1e3;   ///< largest correction, relative to the least one
  int most_growing = 2;      ///< growing corrections in a row before the iterations are accelerated
  int max_iterations = 60;   ///< with one factorization
  int helpful_renewals = 3;  ///< factorizations that slow iterations may request
  int most_renewals = 6;     ///< factorizations before a solution is given up
};

/// Thresholds of iterations of contact conditions that follow the motion (solver/tangent_iterations.hpp). Progress is
/// an error below nine tenths of the best one.
struct ContactThresholds {
  int plain_iterations = 6;  ///< iterations that settle by themselves take fewer
  int max_iterations = 400;
  /// Iterations without progress after which the acceleration is restarted, since points that touch and separate change
  /// the map; after which pairs of facets are frozen; and after which the step fails.
  int patience_of_acceleration = 20, patience_of_pairs = 25, patience_of_iterations = 60;
  /// After so many iterations, of which the last ones brought no progress, the error may be this multiple of the
  /// rounding of the gaps: forces that rotate with large surfaces keep it.
  int patient_iterations = 40, patience_of_rounding = 5;
  double remaining_rounding = 100.0;
  /// Multiple that is accepted before a step fails: gaps have the rounding of everything that moves the points, and in
  /// narrow corners more than once.
  int last_iterations = 60;
  double max_remaining_rounding = 1e4;
};

/// Number of times that a correction which inverts a cell is halved.
inline constexpr int most_halvings = 5;

}  // namespace ricochet
