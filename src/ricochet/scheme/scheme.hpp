#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/last_step.hpp"
#include "ricochet/scheme/scheme_traits.hpp"
#include "ricochet/step/stage_solve.hpp"

/// @file Time schemes. To add one: a file with a class and its registration, one line in registry.cpp, and its tests.
namespace ricochet {

class Scheme {
 public:
  explicit Scheme(double step, const SchemeTraits& traits = {}) : step_(step), traits_(traits) {}
  virtual ~Scheme() = default;
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  [[nodiscard]] const SchemeTraits& traits() const { return traits_; }
  /// Properties for this problem; those of the reactions are known after analyse().
  [[nodiscard]] virtual ProblemTraits traits_for(const SemidiscreteProblem&) const { return {}; }
  /// Limit on the step for this problem, before analyse(); none if every step is stable or the scheme refuses the
  /// problem.
  [[nodiscard]] virtual std::optional<double> stability_limit(const SemidiscreteProblem&) const { return std::nullopt; }
  /// Critical step, below which steps are stable; infinite without such a limit. Known after analyse(); if it changes
  /// with the deformation, the smallest value so far.
  [[nodiscard]] virtual double critical_step() const { return std::numeric_limits<double>::infinity(); }

  /// Step size h.
  [[nodiscard]] double step() const { return step_; }
  /// Sets the length of the following steps, after analyse(). The operators change with it.
  void change_step(const SemidiscreteProblem& problem, double step) {
    step_ = step;
    step_changed(problem);
  }
  /// Operators of the stages of a step, in order.
  [[nodiscard]] virtual std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const = 0;

  /// Computes everything that is constant over the steps, before start(). A scheme keeps nothing else from step to
  /// step: data for the next step are in the state, so that a run can be resumed from a checkpoint.
  virtual void analyse(const SemidiscreteProblem&) {}
  /// Completes a starting state whose displacement, velocity, acceleration and forces satisfy the momentum equation at
  /// t = 0. May have stages solved; energies and momenta are counted from the resulting state.
  virtual void start(const SemidiscreteProblem&, State&, StageSolve&) {}
  /// Advances the state to the end of the step: fills stages, has them solved and reads their solutions. `increment`
  /// receives the displacement on which the step's forces do work: the forces of one stage, in state.forces, are the
  /// step's; those of the others enter last_step(). Changes the state only after the last
  /// solve, so that a failed step leaves it unchanged.
  virtual void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) = 0;

  /// Applies an impulse between two steps that changes the velocity of the body by these values per dof: zero where a
  /// support prescribes it.
  virtual void change_velocity(State& state, const Vector& change) const { state.velocity += change; }

  /// Computes displacement and velocity at which the scheme accounts for energy: the state's if energy_instant is 0.
  virtual void energy_state(const State& state, Vector& displacement, Vector& velocity) const;
  /// Internal force at that displacement, if the state has it: the elastic energy then needs no product with K. Else
  /// null.
  [[nodiscard]] virtual const Vector* internal_force(const State&) const { return nullptr; }
  /// Computes an acceleration a such that impulses change the momentum M (V + h a), and returns true; false if they
  /// change M V.
  [[nodiscard]] virtual bool momentum_acceleration(const State&, Vector&) const { return false; }
  /// Closed-form term that the scheme conserves together with the energy.
  [[nodiscard]] virtual double algorithmic_energy(const SemidiscreteProblem&, const State&) const { return 0.0; }
  /// Report on the last step.
  [[nodiscard]] virtual LastStep last_step() const { return {}; }

 protected:
  /// Updates constants that depend on h.
  virtual void step_changed(const SemidiscreteProblem&) {}

 private:
  double step_;
  SchemeTraits traits_;
};

/// Makes a scheme for a step size h.
using SchemeConstructor = std::function<std::unique_ptr<Scheme>(double step, const Parameters& parameters)>;
using SchemeRegistration = Registration<SchemeConstructor>;

/// Registry of all schemes. Programs may add their own.
[[nodiscard]] Registry<SchemeConstructor>& scheme_registry();
[[nodiscard]] inline std::vector<std::string> scheme_names() {
  return scheme_registry().names();
}
/// Makes a scheme by name, with the values of its keys: make_scheme("newmark", 1e-4, {{"beta", 0.25}, {"gamma", 0.5}}).
/// Throws Error(invalid_input), which lists the names or the missing or unknown parameter.
[[nodiscard]] std::unique_ptr<Scheme> make_scheme(const std::string& name, double step, Parameters parameters = {});

}  // namespace ricochet
