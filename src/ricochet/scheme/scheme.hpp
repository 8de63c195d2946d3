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
#include "ricochet/scheme/stage_solve.hpp"
#include "ricochet/scheme/step_part.hpp"

/// @file Time schemes. To add one: a file with a class and its registration, one line in registry.cpp, and its tests.
namespace ricochet {

/// How a step's forces and displacement enter the balance of energy:
/// work of a force F over a step = incrementᵀ (previous_weight F_previous + current_weight F_current).
struct WorkRule {
  double previous_weight = 0.0;
  double current_weight = 1.0;
};

/// What the balance of energy of the last step has besides the works of forces on increments, in closed form.
struct StepCorrections {
  double contact_work = 0.0;           ///< where the contact forces act along a path that is not straight
  double friction_work = 0.0;          ///< likewise
  double support_work = 0.0;           ///< of reactions that are none of the step's own
  double load_work = 0.0;              ///< of loads that vary on nodes without inertia
  double numerical_dissipation = 0.0;  ///< energy that the scheme itself takes away, positive when it is lost
  /// ΔW less the work of the internal forces that the scheme takes for a step, where these are no linear function of
  /// the displacement: energy that appears, of either sign.
  double integration_error = 0.0;
  double viscous_dissipation = 0.0;  ///< of stress that relaxes, never negative
};

class Scheme {
 public:
  explicit Scheme(double step) : step_(step) {}
  virtual ~Scheme() = default;
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  /// h.
  [[nodiscard]] double step() const { return step_; }
  /// Steps of different lengths may follow one another: neither what is remembered nor energy_state() depends on the
  /// last one's, and advance() moves by step(). (algorithmic_energy() may: the account books the difference.)
  [[nodiscard]] virtual bool changes_step() const { return false; }
  /// The length of the steps from now on, after analyse(). Operators are others then.
  void change_step(const SemidiscreteProblem& problem, double step) {
    step_ = step;
    step_changed(problem);
  }
  /// The operators of the stages of a step, in order.
  [[nodiscard]] virtual std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const = 0;
  /// Instants of energies and forces in a row of the history, relative to its time, in steps; for docs and summary.
  [[nodiscard]] virtual double energy_instant() const { return 0.0; }
  [[nodiscard]] virtual double force_instant() const { return 0.0; }
  /// The same of what acted over a step: its middle where the forces shown are those of its end.
  [[nodiscard]] virtual double acting_instant() const { return force_instant(); }
  [[nodiscard]] virtual WorkRule work_rule() const { return {}; }
  /// Steps below this one are stable; infinite without such a limit. Known after analyse(); where it changes with the
  /// deformation, the smallest so far.
  [[nodiscard]] virtual double critical_step() const { return std::numeric_limits<double>::infinity(); }

  // What others should know of it, so that nobody has to know it by name.
  /// Steps between rows of the history where a case does not say: more than one where a row costs over half a step.
  [[nodiscard]] virtual long history_every() const { return 1; }
  /// A limit on the step that it asks for with this problem, before analyse(); none where every step is stable or where
  /// it refuses the problem.
  [[nodiscard]] virtual std::optional<double> stability_limit(const SemidiscreteProblem&) const { return std::nullopt; }
  /// Its steps are right where the internal force is no linear function of the displacement.
  [[nodiscard]] virtual bool takes_nonlinear_force() const { return false; }
  /// And its steps relax the stress of branches beside the laws (viscous_force.hpp), and say what that dissipates.
  [[nodiscard]] virtual bool takes_relaxation() const { return false; }
  /// Rigid bodies that move by the forces on them (free_motion.hpp) are part of its steps.
  /// Of a body that is divided among ranks: all that it does is what each does with its part, and stages.
  [[nodiscard]] virtual bool takes_ranks() const { return true; }
  [[nodiscard]] virtual bool takes_free_bodies() const { return false; }
  /// Then its steps change the angular momentum about current positions by the moments of outer forces alone, about the
  /// positions where these act.
  [[nodiscard]] virtual bool keeps_moments_at_finite_strain() const { return false; }
  /// The displacement at which the forces of the last step act then, those of its end that is; null: half way.
  [[nodiscard]] virtual const Vector* place_of_forces() const { return nullptr; }
  /// The forces of contact between bodies have couples there (ContactGeometry::add_couples).
  [[nodiscard]] virtual bool has_couples_between_bodies() const { return false; }
  /// With a mass without inertia on contact nodes its contact forces create hardly any energy.
  [[nodiscard]] virtual bool suits_singular_mass() const { return false; }
  /// Nodes with inertia that friction holds keep a velocity of alternating sign.
  [[nodiscard]] virtual bool stuck_nodes_alternate() const { return false; }
  /// What goes wrong with steps of more than some times the time in which a wave crosses a cell: the rest of a sentence
  /// that begins with such a step. Empty: nothing that is known.
  struct LongSteps {
    double crossings = 1.0;
    std::string trouble = {};
  };
  [[nodiscard]] virtual LongSteps long_steps(const SemidiscreteProblem&) const { return {}; }
  /// Which reactions act on the body over a step, of schemes that leave it open; none where there is no contact.
  [[nodiscard]] virtual std::optional<ReactionMean> acting_reactions(const SemidiscreteProblem&) const {
    return std::nullopt;
  }
  /// What a jump in the velocity of a prescribed displacement leaves in the steps that follow.
  enum class JumpResponse { fades, alternates, grows };
  [[nodiscard]] virtual JumpResponse jump_response() const { return JumpResponse::fades; }

  /// Computes what stays the same in all steps, before start(). A scheme keeps nothing else from step to step: what a
  /// step leaves for the next one is in the state, so that a run can go on from a checkpoint.
  virtual void analyse(const SemidiscreteProblem&) {}
  /// Completes a starting state whose displacement, velocity, acceleration and forces satisfy the momentum equation at
  /// t = 0. May have stages solved; energies and momenta are counted from what it leaves.
  virtual void start(const SemidiscreteProblem&, State&, StageSolve&) {}
  /// Takes the state to the end of the step: fills stages, has them solved, and reads their solutions. `increment`
  /// receives the displacement that the step's forces work on: of all stages those of one, in state.forces, are the
  /// step's; what another's do is in step_corrections() or other_parts(). Changes the state only after the last solve,
  /// so that a step that fails leaves it as it was.
  virtual void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) = 0;

  /// Between two steps an impulse has changed the velocity of the body, by these values per dof: zero where a support
  /// prescribes it.
  virtual void change_velocity(State& state, const Vector& change) const { state.velocity += change; }

  /// Displacement and velocity at which the scheme accounts for energy: the state's where energy_instant() is 0.
  virtual void energy_state(const State& state, Vector& displacement, Vector& velocity) const;
  /// The internal force at that displacement, where the state has it: then the elastic energy needs no product with K.
  [[nodiscard]] virtual const Vector* internal_force(const State&) const { return nullptr; }
  /// An acceleration a such that M (V + h a) is the momentum that impulses change, where M V is not: true, and a.
  [[nodiscard]] virtual bool momentum_acceleration(const State&, Vector&) const { return false; }
  /// A closed-form term that the scheme conserves together with the energy.
  [[nodiscard]] virtual double algorithmic_energy(const SemidiscreteProblem&, const State&) const { return 0.0; }
  [[nodiscard]] virtual StepCorrections step_corrections(const SemidiscreteProblem&) const { return {}; }
  /// Forces of the last step that are not in the state.
  [[nodiscard]] virtual std::span<const StepPart> other_parts() const { return {}; }

 protected:
  /// For schemes with constants that depend on h.
  virtual void step_changed(const SemidiscreteProblem&) {}

 private:
  double step_;
};

/// Makes a scheme of a step size h.
using SchemeConstructor = std::function<std::unique_ptr<Scheme>(double step, const Parameters& parameters)>;
using SchemeRegistration = Registration<SchemeConstructor>;

/// All schemes. A program of one's own may add to them.
[[nodiscard]] Registry<SchemeConstructor>& scheme_registry();
[[nodiscard]] inline std::vector<std::string> scheme_names() {
  return scheme_registry().names();
}
/// By name, with the values of its keys: make_scheme("newmark", 1e-4, {{"beta", 0.25}, {"gamma", 0.5}}). Throws
/// Error(invalid_input) that lists the names, or says which parameter is missing or too many.
[[nodiscard]] std::unique_ptr<Scheme> make_scheme(const std::string& name, double step, Parameters parameters = {});

}  // namespace ricochet
