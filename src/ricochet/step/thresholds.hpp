#pragma once

/// @file Thresholds of the two iterations that schemes and solvers share; those of one scheme are beside it. They were
/// chosen on thousands of random cases: another value changes results in their last digits, and how many iterations,
/// cut steps and failures there are.
namespace ricochet {

/// Thresholds of Newton iterations with a factorization that is reused (newton_progress.hpp).
struct NewtonThresholds {
  double least_tolerance = 1e-13;  ///< of the remaining error, relative to the increment, as far as rounding permits
  double loose_tolerance = 1e-9;   ///< of it if rounding keeps the corrections from decreasing further
  double max_rounding = 100.0;     ///< correction in that situation, relative to the rounding of the positions
  double stalled_rate = 0.7;       ///< rate from which on rounding may be the reason
  double slow_rate = 0.5;          ///< rate above which an iteration is slow
  int max_slow = 3;                ///< slow iterations with a new factorization before they are accelerated
  double divergence = 1e3;         ///< largest correction, relative to the least one
  double near = 0.2;    ///< correction, relative to the increment, from which on decreasing ones are accelerated
  int max_growing = 2;  ///< growing corrections in a row before the iterations are accelerated
  int plain_iterations = 1000;   ///< iterations after which all others are accelerated
  int stored_iterations = 20;    ///< which accelerated ones combine
  double renewed_rate = 0.2;     ///< usual rate after a new factorization
  int max_iterations = 60;       ///< iterations with one factorization
  int helpful_renewals = 3;      ///< factorizations that slow iterations may request
  int max_renewals = 6;          ///< factorizations before a solution is given up
  double debt_in_prices = 4.0;   ///< of a factor that is kept over steps (factor_debt.hpp)
  double near_solution = 1e-2;   ///< correction, relative to the increment, at which equations may be refined
  int max_pair_iterations = 80;  ///< iterations after which pairs of facets that keep changing are frozen
  /// Iterations after which brief ones are given up unless fewer are expected to be left, and in any case.
  int early_iterations = 30, max_early_iterations = 120;
  double early_divergence = 20.0;  ///< correction relative to the least one, after which they are given up, too
};

/// Thresholds of iterations with a proximal weight θ (contact_newton.hpp), which decreases with the motion of an
/// iteration: implicit steps of a descent, of which the last ones are Newton's (pseudo-transient continuation: C. T.
/// Kelley, D. E. Keyes, SIAM J. Numer. Anal. 35 (1998) 508–523).
struct ProximalThresholds {
  double first = 1.0;                             ///< θ of the first iteration
  double largest_decrease = 0.3, growth = 2.0;    ///< factors of θ from one iteration to the next
  double least = 1e-3;                            ///< θ below which it is zero
  double least_after_failure = 0.1, retry = 4.0;  ///< θ, and its factor, after an iteration that inverts a cell or has
                                                  ///< no solution
  int max_iterations = 60;
  int max_failures = 10;  ///< iterations in a row that invert a cell or have no solution
};

/// Thresholds of iterations of contact conditions that follow the motion (solver/tangent_iterations.hpp).
struct ContactThresholds {
  int plain_iterations = 6;  ///< iterations that settle by themselves take fewer
  int max_iterations = 400;
  double progress = 0.9;  ///< error, relative to the best one, below which an iteration makes progress
  /// Iterations without progress after which the acceleration is restarted, since points that touch and separate change
  /// the map.
  int max_stalled_acceleration = 20;
  int max_stalled_pairs = 25;       ///< iterations without progress after which pairs of facets are frozen
  int max_stalled_iterations = 60;  ///< iterations without progress after which the step fails
  /// Iterations, of which the last ones brought no progress, after which the error may be max_rounding times the
  /// rounding of the gaps: forces that rotate with large surfaces keep it.
  int rounding_iterations = 40, max_stalled_rounding = 5;
  double max_rounding = 100.0;
  /// Iterations after which the error may be max_last_rounding times the rounding of the gaps, before a step fails:
  /// gaps have the rounding of everything that moves the points, and in narrow corners more than once.
  int last_iterations = 60;
  double max_last_rounding = 1e4;
};

/// Number of times that a correction which inverts a cell is halved.
inline constexpr int max_halvings = 5;

}  // namespace ricochet
