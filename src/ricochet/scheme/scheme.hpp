#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/stage_solve.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Time schemes. To add one: a file with a class, one line in registry.cpp, and its tests.
namespace ricochet {

/// Parameters of schemes, from [time] of a case.
struct SchemeParameters {
  std::string name;
  double step = 0.0;   ///< h
  double beta = 0.25;  ///< newmark
  double gamma = 0.5;  ///< newmark
  /// semi-explicit: refuse a step above the critical one. Only tests of instability go without.
  bool check_critical_step = true;
};

/// How a step's forces and displacement enter the balance of energy:
/// work of a force F over a step = incrementᵀ (previous_weight F_previous + current_weight F_current).
struct WorkRule {
  double previous_weight = 0.0;
  double current_weight = 1.0;
};

class Scheme {
 public:
  explicit Scheme(const SchemeParameters& parameters) : step_(parameters.step) {}
  virtual ~Scheme() = default;
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  /// h.
  [[nodiscard]] double step() const { return step_; }
  /// The operators of the stages of a step, in order.
  [[nodiscard]] virtual std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const = 0;
  /// Instants of energies and forces in a row of the history, relative to its time, in steps; for docs and summary.
  [[nodiscard]] virtual double energy_instant() const { return 0.0; }
  [[nodiscard]] virtual double force_instant() const { return 0.0; }
  [[nodiscard]] virtual WorkRule work_rule() const { return {}; }
  /// Steps below this one are stable; infinite without such a limit. Known after analyse().
  [[nodiscard]] virtual double critical_step() const { return std::numeric_limits<double>::infinity(); }

  /// Computes what stays the same in all steps, before start(). A scheme keeps nothing else from step to step: what a
  /// step leaves for the next one is in the state, so that a run can go on from a checkpoint.
  virtual void analyse(const SemidiscreteProblem&) {}
  /// Completes a starting state whose displacement, velocity, acceleration and forces satisfy the momentum equation at
  /// t = 0.
  virtual void start(const SemidiscreteProblem&, State&) {}
  /// Takes the state to the end of the step: fills stages, has them solved, and reads their solutions. `increment`
  /// receives the displacement that the step's forces work on. Changes the state only after the last solve, so that a
  /// step that fails leaves it as it was.
  virtual void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) = 0;

  /// Displacement and velocity at which the scheme accounts for energy.
  virtual void energy_state(const State& state, Vector& displacement, Vector& velocity) const;
  /// A closed-form term that the scheme conserves together with the energy.
  [[nodiscard]] virtual double algorithmic_energy(const SemidiscreteProblem&, const State&) const { return 0.0; }
  /// Energy that the scheme itself takes away in the last step, in closed form.
  [[nodiscard]] virtual double numerical_dissipation(const SemidiscreteProblem&) const { return 0.0; }

 private:
  double step_;
};

/// By name; throws Error(invalid_input) that lists the names.
[[nodiscard]] std::unique_ptr<Scheme> make_scheme(const SchemeParameters& parameters);
[[nodiscard]] std::vector<std::string> scheme_names();

}  // namespace ricochet
