#include "ricochet/simulation/statics/finite_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/simulation/statics/equilibrium_equations.hpp"

namespace ricochet {

namespace {

constexpr double shortest_increment = 1e-5;
/// Tolerance of the end of a part from which another one continues.
constexpr double near = 1e-6;
/// Motion along an unstable direction from which a descent begins, relative to the size of the bodies.
constexpr double perturbation = 1e-3;
constexpr int most_descents = 4, most_iterations = 60;
/// Longest motion in an iteration of a descent, relative to the size of the bodies.
constexpr double longest_motion = 0.1;
/// Corrections that grow lead to another branch of equilibria: beyond the loads that a body can carry there may be
/// some.
constexpr NewtonThresholds continuous = {.divergence = 10.0, .max_renewals = 3},
                           exact = {.divergence = 2.0, .max_iterations = 15, .max_renewals = 0};
constexpr NewtonThresholds disturbed = {.max_iterations = 30, .max_renewals = 0, .early_divergence = 1e4};
/// Iterations of the proximal point method may converge slowly.
constexpr NewtonThresholds settling = {.max_iterations = 100, .max_renewals = 3};

class LoadPath {
 public:
  LoadPath(const SemidiscreteProblem& problem, const Vector& guess, const StepSolverOptions& options)
      : iterate_(problem, guess), kept_(iterate_, options), exact_(iterate_) {}

  /// Advances to the equilibrium under a part of loads and prescribed displacements, near enough to continue from. The
  /// displacement is that of the start if this fails. Throws Error(not_converged).
  void advance(double part) {
    const Vector start = iterate_.displacement();
    const Reactions reactions = iterate_.reactions();
    const auto attempt = [&](ContactNewton& newton, EquilibriumEquations& equations, double price) {
      try {
        iterate_.start(part);
        iterate_.evaluate();
        newton.solve(equations, {iterate_.rounding(), price, near}, Persistence::brief);
      } catch (const Error&) {
        iterate_.displacement() = start;
        iterate_.set_reactions(reactions);
        throw;
      }
    };
    try {
      attempt(kept_newton_, kept_, kept_.renewal_price());
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      log::debug(std::string("kept factor: ") + error.what());
      attempt(exact_newton_, exact_, std::numeric_limits<double>::infinity());
    }
  }

  /// Iterates under the full loads until the residual of all forces is rounding. Throws Error(not_converged).
  void settle() {
    const Vector start = iterate_.displacement();
    const auto attempt = [&](ContactNewton& newton, EquilibriumEquations& equations, Persistence persistence) {
      equations.settle();
      iterate_.displacement() = start;  // slips remain those of the last part
      iterate_.evaluate();
      newton.solve(equations, {iterate_.rounding(), kept_.renewal_price()}, persistence);
    };
    const auto is_solved = [&](ContactNewton& newton, EquilibriumEquations& equations) {
      try {
        attempt(newton, equations, Persistence::brief);
        return true;
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::not_converged) throw;
        return false;
      }
    };
    if (!is_solved(kept_newton_, kept_) && !is_solved(last_newton_, exact_))
      attempt(settling_newton_, kept_, Persistence::full);
    leave_unstable_equilibria();
  }

  [[nodiscard]] StaticEquilibrium result() const {
    return {iterate_.displacement(), iterate_.reactions().normal_reaction};
  }

 private:
  /// Descends from an unstable equilibrium to a stable one, as a body that is disturbed does.
  void leave_unstable_equilibria() {
    Vector direction;
    for (int descent = 0;; ++descent) {
      const Index unstable = exact_.unstable_directions(direction);
      if (unstable == 0) return;
      if (descent == most_descents || !descend(direction)) {
        log::warning(
            "initial.displacement = \"static\": the equilibrium is unstable, and no stable one was found near it: the "
            "body will move away from it, in a direction that rounding chooses");
        return;
      }
      log::info(
          fmt::format("a static equilibrium is unstable in {} (buckling): the body is disturbed, and moves to "
                      "another one",
                      unstable == 1 ? "one direction" : fmt::format("{} directions", unstable)));
    }
  }
  /// Returns false, with the present equilibrium, if no other one is found.
  bool descend(const Vector& direction) {
    const Vector start = iterate_.displacement();
    const Reactions reactions = iterate_.reactions();
    iterate_.start(1.0);
    iterate_.displacement() += (perturbation * iterate_.size() / direction.lpNorm<Eigen::Infinity>()) * direction;
    try {
      (void)ContactNewton::evaluate_with_halving(exact_);
      approach();
      exact_.settle();
      last_newton_.solve(exact_, {iterate_.rounding(), std::numeric_limits<double>::infinity()}, Persistence::brief);
      return true;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      log::debug(std::string("descent: ") + error.what());
    }
    iterate_.displacement() = start;
    iterate_.set_reactions(reactions);
    iterate_.evaluate();
    return false;
  }

  /// Iterates with the least proximal weights with which the tangent is positive definite, until none is needed. Throws
  /// Error(not_converged).
  void approach() {
    int plain = 0;
    double last = 0.0;
    for (int iteration = 0; plain < 2; ++iteration) {
      if (iteration == most_iterations) throw Error(ErrorKind::not_converged, "the disturbed body does not settle");
      const double weight = exact_.least_definite_weight();
      exact_.set_proximal_weight(weight);
      double correction = exact_.iterate().correction;
      plain = weight == 0.0 && correction < last ? plain + 1 : 0;
      last = correction;
      for (; correction > longest_motion * iterate_.size(); correction *= 0.5) iterate_.halve();
      (void)ContactNewton::evaluate_with_halving(exact_);
      log::debug(fmt::format("disturbed body: weight {:.2e}, correction {:.2e}", weight, correction));
    }
  }

  EquilibriumIterate iterate_;
  KeptFactorEquilibrium kept_;
  ExactEquilibrium exact_;
  ContactNewton kept_newton_{continuous}, exact_newton_{exact}, settling_newton_{settling}, last_newton_{disturbed};
};

}  // namespace

StaticEquilibrium finite_equilibrium(const SemidiscreteProblem& problem, const Vector& guess,
                                     const StepSolverOptions& step_options) {
  StepSolverOptions options = step_options;
  options.solves = 0;
  LoadPath path(problem, guess, options);
  double reached = 0.0, increment = 1.0;
  while (reached < 1.0) {
    const double part = std::min(1.0, reached + increment);
    try {
      path.advance(part);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      increment *= 0.25;
      if (increment >= shortest_increment) continue;
      throw Error(
          ErrorKind::not_converged,
          fmt::format("initial.displacement = \"static\": no equilibrium was found beyond {:.4g} times the loads and "
                      "prescribed displacements at t = 0 ({}); there the body may buckle, snap through, or be held by "
                      "nothing: apply smaller ones, add a [[support]], or start at rest without a static equilibrium",
                      reached, error.what()));
    }
    reached = part;
    increment *= 2.0;
  }
  try {
    path.settle();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_converged) throw;
    throw Error(
        ErrorKind::not_converged,
        fmt::format("initial.displacement = \"static\": the body still moves after many iterations ({}): nothing "
                    "holds it under the loads at t = 0; add a [[support]] in the direction in which it is free "
                    "to move or turn",
                    error.what()));
  }
  return path.result();
}

}  // namespace ricochet
