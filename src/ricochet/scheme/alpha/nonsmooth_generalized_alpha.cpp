#include "ricochet/base/error.hpp"
#include "ricochet/scheme/alpha/nonsmooth_stages.hpp"
#include "ricochet/scheme/requirements.hpp"
#include "ricochet/scheme/restitution_key.hpp"

namespace ricochet {

namespace {

/// Nonsmooth generalized-α scheme (O. Brüls, V. Acary, A. Cardona, Comput. Methods Appl. Mech. Engrg. 281 (2014)
/// 131–161), without friction and damping. The acceleration a is that without contact, M a = L − K U; the algorithmic
/// acceleration A follows from it as under generalized-alpha (AlphaScheme), (1−α_m)A₁ + α_mA₀ = (1−α_f)a₁ + α_fa₀.
/// Contact acts through the jumps Q of the positions, with multipliers ν, and W of the velocities, with impulses Λ and
/// the coefficient of restitution e:
///   U₁ = U₀ + hV₀ + h²[(½−β)A₀+βA₁] + Q,   M Q = Gᵀν,   0 ≤ ν ⟂ g(U₁) ≥ 0;
///   V₁ = V₀ + hA* + W,   A* = (1−γ)A₀+γA₁,   M W = GᵀΛ,   0 ≤ Λ ⟂ G V₁ + e G V₀ ≥ 0 where ν > 0 or g(U₁) = 0.
/// The unknown of the first problem is x = U₁ from AlphaScheme's base, r = αν, so that M (a₁ + αQ) = αM δ; that of the
/// second is V₁ from V₀ + hA*. The force of a step is Λ/h. No point penetrates or drifts. With the energy J, which
/// contains the potential of constant loads, and F̄ = (1−α_f)F₁+α_fF₀ of the forces that are neither in J nor contact,
/// J + ½h²(β−γ/2)AᵀMA changes in a step by
///   (GᵀΛ)ᵀ(V₀+V₁)/2 + ΔUᵀF̄ − (½−α_f)(ΔUᵀKΔU + ΔUᵀMΔA) − ½h²(β−γ/2)(2γ−1)ΔAᵀMΔA − (Q−½hW)ᵀMA*;
/// the last term has no sign: contact can create energy.
class NonsmoothGeneralizedAlpha final : public Scheme {
 public:
  NonsmoothGeneralizedAlpha(double step, double spectral_radius, double restitution)
      : NonsmoothGeneralizedAlpha(step, generalized_alpha_weights(step, spectral_radius), restitution) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    return {{weights_.alpha, 1.0, 0.0}, {1.0, 0.0, 0.0}};
  }
  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override {
    return weights_.energy_factor * problem.mass.quadratic_form(state.dof_memory(algorithmic_acceleration));
  }
  bool momentum_acceleration(const State& state, Vector& acceleration) const override {
    acceleration = (0.5 - weights_.force_weight) * state.dof_memory(algorithmic_acceleration);
    return true;
  }
  [[nodiscard]] LastStep last_step() const override { return {.corrections = corrections_}; }

  void analyse(const SemidiscreteProblem& problem) override {
    require_contact_inertia(problem, "nonsmooth-generalized-alpha", "its impulses change their velocities");
    if (!problem.contact.has_friction() && !problem.has_damping()) return;
    throw Error(ErrorKind::invalid_input,
                "scheme \"nonsmooth-generalized-alpha\" supports neither friction nor damping, which couple its two "
                "contact problems; remove them, or use scheme \"moreau-jean\"");
  }

  void start(const SemidiscreteProblem& problem, State& state, StageSolve& stages) override {
    contact_problems_.start(problem, state, stages);
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step();
    contact_problems_.solve_positions(problem, state, h, weights_, stages);
    const StageSolution& impact = contact_problems_.solve_velocities(problem, state, h, weights_, stages);
    // Λ/h does work on this increment.
    increment = (0.5 * h) * (state.velocity + contact_problems_.predicted_velocity + impact.increment);
    compute_corrections(problem, state.time, impact, increment, state.dof_memory(smooth_varying_load));
    store_forces(problem, stages, impact, state);
    state.displacement += contact_problems_.displacement_increment;
    state.velocity = contact_problems_.predicted_velocity + impact.increment;
    state.acceleration = contact_problems_.acceleration_without_contact;
    state.dof_memory(algorithmic_acceleration) = contact_problems_.algorithmic_end;
    state.memory.at(smooth_support_reaction, problem.supports.size()) =
        contact_problems_.support_reaction_without_contact;
  }

 protected:
  void step_changed(const SemidiscreteProblem&) override {
    weights_ = AlphaWeights(step(), weights_.inertia_weight, weights_.force_weight);
  }

 private:
  NonsmoothGeneralizedAlpha(double step, const AlphaWeights& weights, double restitution)
      : Scheme(step, {.acting_instant = -0.5,
                      .supports_step_changes = true,
                      .jump_response = weights.gamma > 0.5 ? JumpResponse::damped : JumpResponse::undamped}),
        weights_(weights),
        contact_problems_(restitution) {}

  /// Computes the corrections of the energy account: the works of varying loads and supports in F̄ on ΔU less those on
  /// the increment, and as numerical dissipation the terms that the identity above subtracts. Replaces the varying load
  /// contained in a₀, `load_of_acceleration`, by that contained in a₁.
  void compute_corrections(const SemidiscreteProblem& problem, double time, const StageSolution& impact,
                           const Vector& increment, Vector& load_of_acceleration) {
    const NonsmoothStages& solved = contact_problems_;
    const double h = step(), instant_offset = 0.5 - weights_.force_weight;  // ½−α_f, of F̄ from the middle of the step
    excess_displacement_ = solved.displacement_increment - increment;
    corrections_ = {.support_work = problem.supports.work(solved.mean_support_reaction, excess_displacement_)};
    if (problem.loads.varies()) {
      problem.loads.varying(time + h, end_load_);
      weighted_load_ = weights_.force_weight * load_of_acceleration + (1.0 - weights_.force_weight) * end_load_;
      load_of_acceleration = end_load_;
      corrections_.load_work = weighted_load_.dot(excess_displacement_);
    }
    problem.mass.multiply(solved.algorithmic_increment, inertia_force_increment_);
    corrections_.numerical_dissipation = instant_offset * solved.displacement_increment.dot(inertia_force_increment_) +
                                         weights_.energy_factor * (2.0 * weights_.gamma - 1.0) *
                                             solved.algorithmic_increment.dot(inertia_force_increment_);
    corrections_.numerical_dissipation +=
        instant_offset * elastic_product(problem, solved.displacement_increment, solved.displacement_increment,
                                         elastic_force_increment_);
    problem.mass.multiply(solved.algorithmic_mean, mean_inertia_force_);
    corrections_.numerical_dissipation +=
        (solved.position_jump - (0.5 * h) * impact.increment).dot(mean_inertia_force_);
  }

  /// Stores the impulses of the step as forces: divided by h.
  void store_forces(const SemidiscreteProblem& problem, StageSolve& stages, const StageSolution& impact, State& state) {
    mean_solution_.normal_reaction = impact.normal_reaction / step();
    mean_solution_.support_reaction = contact_problems_.mean_support_reaction + impact.support_reaction / step();
    mean_solution_.contact_status = impact.contact_status;
    contact_problems_.equations().store_contact(stages.stage(NonsmoothStages::velocity_stage), mean_solution_, step(),
                                                state);
    if (problem.loads.varies()) state.forces.varying_load = weighted_load_;
  }

  AlphaWeights weights_;
  NonsmoothStages contact_problems_;
  StepCorrections corrections_;
  Vector excess_displacement_;       ///< ΔU less the increment
  Vector end_load_, weighted_load_;  ///< varying load at the end of the step, and its part of F̄
  Vector inertia_force_increment_;   ///< MΔA
  Vector elastic_force_increment_;   ///< KΔU
  Vector mean_inertia_force_;        ///< MA*
  StageSolution mean_solution_;      ///< mean forces over the step
};

}  // namespace

SchemeRegistration nonsmooth_generalized_alpha_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<NonsmoothGeneralizedAlpha>(step, parameters.number("spectral_radius"),
                                                       parameters.number("restitution"));
  };
  return {"nonsmooth-generalized-alpha", make, {spectral_radius_key(0.0), restitution_key()}};
}

}  // namespace ricochet
