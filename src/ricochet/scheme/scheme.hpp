#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/step_part.hpp"
#include "ricochet/step/stage_solve.hpp"

/// @file Time schemes. To add one: a file with a class and its registration, one line in registry.cpp, and its tests.
namespace ricochet {

/// Weights of a step's forces in the balance of energy:
/// work of a force F over a step = incrementᵀ (previous_weight F_previous + current_weight F_current).
struct WorkRule {
  double previous_weight = 0.0;
  double current_weight = 1.0;
};

/// Closed-form terms of the energy balance of the last step besides the works of forces on increments.
struct StepCorrections {
  double contact_work = 0.0;           ///< if the contact forces act along a path that is not straight
  double friction_work = 0.0;          ///< likewise
  double support_work = 0.0;           ///< of reactions that do not belong to the step's forces
  double load_work = 0.0;              ///< of loads that vary on nodes without inertia
  double numerical_dissipation = 0.0;  ///< energy dissipated by the scheme itself, positive if lost
  /// ΔW less the work of the scheme's internal forces over a step, if these are nonlinear in the displacement: spurious
  /// energy of either sign.
  double integration_error = 0.0;
  double viscous_dissipation = 0.0;  ///< of viscoelastic branches, never negative
};

class Scheme {
 public:
  explicit Scheme(double step) : step_(step) {}
  virtual ~Scheme() = default;
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  /// Step size h.
  [[nodiscard]] double step() const { return step_; }
  /// True if steps of different lengths may follow one another: neither the state's memory nor energy_state() depends
  /// on the last length, and advance() moves by step(). (algorithmic_energy() may: the account books the difference.)
  [[nodiscard]] virtual bool supports_step_changes() const { return false; }
  /// Sets the length of the following steps, after analyse(). The operators change with it.
  void change_step(const SemidiscreteProblem& problem, double step) {
    step_ = step;
    step_changed(problem);
  }
  /// Operators of the stages of a step, in order.
  [[nodiscard]] virtual std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const = 0;
  /// Instants of energies and forces in a row of the history, relative to its time, in steps; for documentation and
  /// summary.
  [[nodiscard]] virtual double energy_instant() const { return 0.0; }
  [[nodiscard]] virtual double force_instant() const { return 0.0; }
  /// Instant of the forces that acted over a step, likewise: its middle if the forces shown are those of its end.
  [[nodiscard]] virtual double acting_instant() const { return force_instant(); }
  [[nodiscard]] virtual WorkRule work_rule() const { return {}; }
  /// Critical step, below which steps are stable; infinite without such a limit. Known after analyse(); if it changes
  /// with the deformation, the smallest value so far.
  [[nodiscard]] virtual double critical_step() const { return std::numeric_limits<double>::infinity(); }

  // Traits of a scheme, so that no caller has to know it by name.
  /// Default number of steps between rows of the history: more than one if a row costs over half a step.
  [[nodiscard]] virtual long history_every() const { return 1; }
  /// Limit on the step for this problem, before analyse(); none if every step is stable or the scheme refuses the
  /// problem.
  [[nodiscard]] virtual std::optional<double> stability_limit(const SemidiscreteProblem&) const { return std::nullopt; }
  /// True if the scheme supports internal forces that are nonlinear in the displacement.
  [[nodiscard]] virtual bool supports_nonlinear_force() const { return false; }
  /// True if, in addition, its steps relax viscoelastic branches (viscous_force.hpp) and report their dissipation.
  [[nodiscard]] virtual bool supports_relaxation() const { return false; }
  /// True if the scheme supports a body divided among ranks: it operates on each rank's part and solves stages.
  [[nodiscard]] virtual bool supports_ranks() const { return true; }
  /// True if rigid bodies that move under the forces on them (free_motion.hpp) are part of its steps.
  [[nodiscard]] virtual bool supports_free_bodies() const { return false; }
  /// True if, at finite strain, its steps change the angular momentum about current positions only by the moments of
  /// external forces about the positions at which these act.
  [[nodiscard]] virtual bool conserves_moments_at_finite_strain() const { return false; }
  /// Displacement at which the end forces of the last step act at finite strain; null: half way through the step.
  [[nodiscard]] virtual const Vector* displacement_of_forces() const { return nullptr; }
  /// True if contact forces between bodies have couples there (ContactGeometry::add_couples).
  [[nodiscard]] virtual bool has_couples_between_bodies() const { return false; }
  /// True if its contact forces create hardly any energy with a mass without inertia on contact nodes.
  [[nodiscard]] virtual bool suits_singular_mass() const { return false; }
  /// True if nodes with inertia that friction holds keep a velocity of alternating sign.
  [[nodiscard]] virtual bool stuck_nodes_alternate() const { return false; }
  /// Consequence of steps longer than `crossings` times the time in which a wave crosses a cell: `trouble` completes a
  /// sentence that begins with such a step. Empty: none known.
  struct LongSteps {
    double crossings = 1.0;
    std::string trouble = {};
    bool shorter_steps_help = true;
  };
  [[nodiscard]] virtual LongSteps long_steps(const SemidiscreteProblem&) const { return {}; }
  /// Reactions that act on the body over a step, for schemes with a choice; none without contact.
  [[nodiscard]] virtual std::optional<ReactionMean> acting_reactions(const SemidiscreteProblem&) const {
    return std::nullopt;
  }
  /// Key and value of the case file with which the scheme loses less energy in impacts of this problem; empty: none.
  [[nodiscard]] virtual std::string setting_that_loses_less(const SemidiscreteProblem&) const { return {}; }
  /// Effect of a jump in the velocity of a prescribed displacement on the forces at its dofs, which have inertia, in
  /// the steps that follow.
  enum class JumpResponse { fades, alternates, grows };
  [[nodiscard]] virtual JumpResponse jump_response() const { return JumpResponse::fades; }

  /// Computes everything that is constant over the steps, before start(). A scheme keeps nothing else from step to
  /// step: data for the next step are in the state, so that a run can be resumed from a checkpoint.
  virtual void analyse(const SemidiscreteProblem&) {}
  /// Completes a starting state whose displacement, velocity, acceleration and forces satisfy the momentum equation at
  /// t = 0. May have stages solved; energies and momenta are counted from the resulting state.
  virtual void start(const SemidiscreteProblem&, State&, StageSolve&) {}
  /// Advances the state to the end of the step: fills stages, has them solved and reads their solutions. `increment`
  /// receives the displacement on which the step's forces do work: the forces of one stage, in state.forces, are the
  /// step's; those of the others enter step_corrections() or other_parts(). Changes the state only after the last
  /// solve, so that a failed step leaves it unchanged.
  virtual void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) = 0;

  /// Applies an impulse between two steps that changes the velocity of the body by these values per dof: zero where a
  /// support prescribes it.
  virtual void change_velocity(State& state, const Vector& change) const { state.velocity += change; }

  /// Computes displacement and velocity at which the scheme accounts for energy: the state's if energy_instant() is 0.
  virtual void energy_state(const State& state, Vector& displacement, Vector& velocity) const;
  /// Internal force at that displacement, if the state has it: the elastic energy then needs no product with K. Else
  /// null.
  [[nodiscard]] virtual const Vector* internal_force(const State&) const { return nullptr; }
  /// Computes an acceleration a such that impulses change the momentum M (V + h a), and returns true; false if they
  /// change M V.
  [[nodiscard]] virtual bool momentum_acceleration(const State&, Vector&) const { return false; }
  /// Closed-form term that the scheme conserves together with the energy.
  [[nodiscard]] virtual double algorithmic_energy(const SemidiscreteProblem&, const State&) const { return 0.0; }
  [[nodiscard]] virtual StepCorrections step_corrections(const SemidiscreteProblem&) const { return {}; }
  /// Forces of the last step that are not in the state.
  [[nodiscard]] virtual std::span<const StepPart> other_parts() const { return {}; }

 protected:
  /// Updates constants that depend on h.
  virtual void step_changed(const SemidiscreteProblem&) {}

 private:
  double step_;
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
