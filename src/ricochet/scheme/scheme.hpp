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
#include "ricochet/step/stage_solve.hpp"

/// @file Time schemes. To add one: a file with a class and its registration, one line in registry.cpp, and its tests.
namespace ricochet {

/// Weights of a step's forces in the balance of energy:
/// work of a force F over a step = incrementᵀ (previous_weight F_previous + current_weight F_current).
struct WorkRule {
  double previous_weight = 0.0;
  double current_weight = 1.0;
};

/// Response of the forces at a prescribed displacement, at dofs with inertia, to a jump of its velocity, in the steps
/// after it: the forces decay, keep oscillating from step to step, or grow.
enum class JumpResponse { damped, undamped, unstable };

/// Properties that hold for every problem, so that no caller has to know a scheme by name. Instants are the time of a
/// quantity less that of its row of the history, in steps: −½ is the middle of the step just done.
struct SchemeTraits {
  double energy_instant = 0.0;  ///< of the displacement and velocity in the energies (Scheme::energy_state)
  double force_instant = 0.0;   ///< of the forces shown
  /// Instant of the forces that acted over a step, if not force_instant: its middle if those shown are of its end.
  std::optional<double> acting_instant = {};
  WorkRule work_rule = {};
  /// Default number of steps between rows of the history: more than one if a row costs over half a step.
  long history_every = 1;
  /// True if steps of different lengths may follow one another: neither the state's memory nor energy_state() depends
  /// on the last length, and advance() moves by step(). (algorithmic_energy() may: the account books the difference.)
  bool supports_step_changes = false;
  /// True if the scheme supports internal forces that are nonlinear in the displacement.
  bool supports_nonlinear_force = false;
  /// True if, in addition, its steps relax viscoelastic branches (viscous_force.hpp) and report their dissipation.
  bool supports_relaxation = false;
  /// True if the scheme supports a body divided among ranks: it operates on each rank's part and solves stages.
  bool supports_ranks = true;
  /// True if rigid bodies that move under the forces on them (free_motion.hpp) are part of its steps.
  bool supports_free_bodies = false;
  /// True if, at finite strain, its steps change the angular momentum about current positions only by the moments of
  /// external forces about the positions at which these act.
  bool conserves_moments_at_finite_strain = false;
  /// True if, at finite strain, corrections of the velocities close the balance of its steps, and are reported.
  bool corrects_velocities = false;
  /// True if its contact forces create hardly any energy with a mass without inertia on contact nodes.
  bool suits_singular_mass = false;
  /// True if nodes with inertia that friction holds keep a velocity of alternating sign.
  bool stuck_nodes_alternate = false;
  JumpResponse jump_response = JumpResponse::damped;
};

/// Consequence of a Courant number (steps per time in which a wave crosses a cell) above a limit.
struct LongSteps {
  double courant_limit = 1.0;
  std::string consequence = {};    ///< end of a sentence that begins with such a step; empty: none known
  bool shorter_steps_help = true;  ///< whether a shorter step is the remedy; otherwise another scheme is
};

/// Properties that depend on the problem.
struct ProblemTraits {
  /// Reactions that act on the body over a step, for schemes with a choice; none without contact.
  std::optional<ActingReaction> acting_reactions = {};
  LongSteps long_steps = {};
  /// Key and value of the case file with which the scheme loses less energy in impacts; empty: none.
  std::string less_dissipative_setting = {};
};

class Scheme {
 public:
  explicit Scheme(double step, const SchemeTraits& traits = {}) : step_(step), traits_(traits) {}
  virtual ~Scheme() = default;
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  [[nodiscard]] const SchemeTraits& traits() const { return traits_; }
  /// Instant of the forces that acted over a step, relative to its end, in steps.
  [[nodiscard]] double acting_instant() const { return traits_.acting_instant.value_or(traits_.force_instant); }
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
[[nodiscard]] inline std::vector<std::string> scheme_names() { return scheme_registry().names(); }
/// Makes a scheme by name, with the values of its keys: make_scheme("newmark", 1e-4, {{"beta", 0.25}, {"gamma", 0.5}}).
/// Throws Error(invalid_input), which lists the names or the missing or unknown parameter.
[[nodiscard]] std::unique_ptr<Scheme> make_scheme(const std::string& name, double step, Parameters parameters = {});

}  // namespace ricochet
