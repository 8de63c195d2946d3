#pragma once

#include <stdexcept>

#include "ricochet/step/newton_progress.hpp"

/// @file The iterations by which all nonlinear equations with contact are solved.
namespace ricochet {

/// Nonlinear equations of a body with contact, at an iterate. An iteration solves linear equations about the iterate
/// with exact contact conditions, and moves to their solution. Lengths and sizes are those of the whole body, also on
/// one of several ranks, which then take the same way.
class NewtonEquations {
 public:
  struct Iteration {
    double correction = 0.0;  ///< size of the last correction: a length
    double increment = 0.0;   ///< size of the increment so far, in the same norm
  };
  virtual ~NewtonEquations() = default;

  /// Solves the linear equations, and moves to their solution. Throws Error(not_converged).
  virtual Iteration iterate() = 0;
  /// Combines the last iterates to a better one (Anderson acceleration), and forgets all but the present one. By
  /// default there is no combination.
  virtual void accelerate() {}
  virtual void forget_iterates() {}
  /// Evaluates the forces at the iterate. Throws Error(not_converged) where a cell is inverted.
  virtual void evaluate() = 0;
  /// Moves half of the way back to the iterate before.
  virtual void halve() = 0;
  /// Makes a new factor at the iterate.
  virtual void renew() {}
  /// Makes the equations more accurate near their solution, and at it. Returns whether they have changed.
  [[nodiscard]] virtual bool refine(bool /*is_solution*/) { return false; }
  /// Whether forces are evaluated at the solution, and accept() is called.
  [[nodiscard]] virtual bool has_conditions_on_solution() const { return false; }
  /// Takes the solution. Returns false if a smaller error is necessary (only if `may_refuse`). Throws
  /// Error(not_converged) if this is no solution.
  [[nodiscard]] virtual bool accept(const Iteration& /*iteration*/, bool /*may_refuse*/) { return true; }
  /// Holds pairs of contact points and facets that keep changing. Returns false if there are none, or if they are held.
  [[nodiscard]] virtual bool freeze() { return false; }

  // For a descent, in which θ times the stiffness of the undeformed body is added to the tangent:
  /// Sets θ ≥ 0 for the following iterations.
  virtual void set_proximal_weight(double /*weight*/) { throw std::logic_error("these equations have no descent"); }
  /// Returns to the iterate before, with its reactions and forces.
  virtual void take_back() { throw std::logic_error("these equations have no descent"); }
};

/// Treatment of iterations that do not converge.
enum class Persistence {
  brief,  ///< they are given up after few, without frozen pairs: something else can be tried
  full
};

/// Sizes to which iterations refer.
struct NewtonScale {
  double rounding;       ///< rounding error of the positions, the smallest meaningful correction
  double renewal_price;  ///< number of iterations that take as long as a new factor (StageSolve)
  double tolerance = NewtonThresholds().least_tolerance;  ///< of the error that is left, relative to the increment
};

/// Solves NewtonEquations: corrections that invert cells are halved, iterations are accelerated and factors renewed as
/// NewtonProgress advises, and pairs that keep changing are frozen.
class ContactNewton {
 public:
  explicit ContactNewton(const NewtonThresholds& thresholds = {}) : thresholds_(thresholds), progress_(thresholds) {}

  /// Iterates from an iterate at which the forces have been evaluated. Throws Error(not_converged).
  void solve(NewtonEquations& equations, const NewtonScale& scale, Persistence persistence);
  /// Approaches the solution with proximal weights that decrease to zero, until Newton's method can take over. An
  /// iteration that inverts a cell is halved, and taken back if that does not help; so is one that has no solution.
  /// Throws Error(not_converged).
  static void descend(NewtonEquations& equations, const ProximalThresholds& thresholds);
  /// Evaluates the forces, and halves the last correction as long as it inverts cells. Returns whether it did.
  [[nodiscard]] static bool evaluate_with_halving(NewtonEquations& equations);
  [[nodiscard]] const NewtonProgress& progress() const { return progress_; }

 private:
  void restart(NewtonEquations& equations);
  [[nodiscard]] bool freeze(NewtonEquations& equations);
  void give_up_early(const NewtonEquations::Iteration& iteration) const;
  void follow(NewtonProgress::Advice advice, NewtonEquations& equations, const NewtonEquations::Iteration& iteration,
              Persistence persistence);

  NewtonThresholds thresholds_;
  NewtonProgress progress_;
};

}  // namespace ricochet
