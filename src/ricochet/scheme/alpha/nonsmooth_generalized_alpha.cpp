#include "ricochet/base/error.hpp"
#include "ricochet/scheme/alpha/nonsmooth_stages.hpp"
#include "ricochet/scheme/requirements.hpp"
#include "ricochet/scheme/restitution_key.hpp"

namespace ricochet {

namespace {

/// Nonsmooth generalized-α scheme (O. Brüls, V. Acary, A. Cardona, Comput. Methods Appl. Mech. Engrg. 281 (2014)
/// 131–161), without friction and damping. Accelerations are those without contact, M a = L − K U, weighted as under
/// generalized-alpha, (1−α_m)A₁ + α_mA₀ = (1−α_f)a₁ + α_fa₀; contact acts through jumps of positions and velocities,
///   U₁ = U₀ + hV₀ + h²[(½−β)A₀+βA₁] + Q,   M Q = Gᵀν,   0 ≤ ν ⟂ g(U₁) ≥ 0;
///   V₁ = V₀ + hA* + W,   A* = (1−γ)A₀+γA₁,   M W = GᵀΛ,   0 ≤ Λ ⟂ G V₁ + e G V₀ ≥ 0 where ν > 0 or g(U₁) = 0.
/// The unknown of the first problem is x = U₁ from AlphaScheme's base, r = αν, so that M (a₁ + αQ) = αM δ; that of the
/// second is V₁ from V₀ + hA*. The force of a step is Λ/h. No point penetrates or drifts. With F̄ = (1−α_f)F₁+α_fF₀ of
/// the forces outside J except contact, in a step J + ½h²(β−γ/2)AᵀMA changes by
///   (GᵀΛ)ᵀ(V₀+V₁)/2 + ΔUᵀF̄ − (½−α_f)(ΔUᵀKΔU + ΔUᵀMΔA) − ½h²(β−γ/2)(2γ−1)ΔAᵀMΔA − (Q−½hW)ᵀMA*;
/// the last term has no sign: contact can create energy.
class NonsmoothGeneralizedAlpha final : public Scheme {
 public:
  NonsmoothGeneralizedAlpha(double step, double spectral_radius, double restitution)
      : Scheme(step), weights_(generalized_alpha_weights(step, spectral_radius)), stages_(restitution) {}

  [[nodiscard]] bool supports_step_changes() const override { return true; }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    return {{weights_.alpha, 1.0, 0.0}, {1.0, 0.0, 0.0}};
  }
  [[nodiscard]] double acting_instant() const override { return -0.5; }
  [[nodiscard]] JumpResponse jump_response() const override {
    return weights_.gamma > 0.5 ? JumpResponse::fades : JumpResponse::alternates;
  }
  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override {
    return weights_.energy_factor * problem.mass.quadratic_form(state.memory.at(algorithmic_acceleration));
  }
  bool momentum_acceleration(const State& state, Vector& acceleration) const override {
    acceleration = (0.5 - weights_.force) * state.memory.at(algorithmic_acceleration);
    return true;
  }
  [[nodiscard]] StepCorrections step_corrections(const SemidiscreteProblem&) const override { return corrections_; }

  void analyse(const SemidiscreteProblem& problem) override {
    require_contact_inertia(problem, "nonsmooth-generalized-alpha", "its impulses change their velocities");
    if (!problem.contact.has_friction() && !problem.has_damping()) return;
    throw Error(ErrorKind::invalid_input,
                "scheme \"nonsmooth-generalized-alpha\" supports neither friction nor damping, which couple its two "
                "contact problems; remove them, or use scheme \"moreau-jean\"");
  }

  void start(const SemidiscreteProblem& problem, State& state, StageSolve& stages) override {
    stages_.start(problem, state, stages);
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step();
    stages_.position(problem, state, h, weights_, stages);
    const StageSolution& impact = stages_.impulses(problem, state, h, weights_, stages);
    increment = (0.5 * h) * (state.velocity + stages_.velocity + impact.increment);  // on which Λ/h does work
    account(problem, state.time, impact, increment, state.memory[smooth_varying_load]);
    store_forces(problem, stages, impact, state);
    state.displacement += stages_.motion;
    state.velocity = stages_.velocity + impact.increment;
    state.acceleration = stages_.smooth;
    state.memory.at(algorithmic_acceleration) = stages_.after;
    state.memory.at(smooth_support_reaction) = stages_.support;
  }

 protected:
  void step_changed(const SemidiscreteProblem&) override {
    weights_ = AlphaWeights(step(), weights_.inertia, weights_.force);
  }

 private:
  /// Books the difference between the work of F̄ on ΔU, where it acts, and on the increment.
  void account(const SemidiscreteProblem& problem, double time, const StageSolution& impact, const Vector& increment,
               Vector& load_before) {
    const double h = step(), less = 0.5 - weights_.force;
    work_on_ = stages_.motion - increment;
    corrections_ = {.support_work = problem.supports.work(stages_.mean_support, work_on_)};
    if (load_before.size() == 0) {  // older checkpoint
      load_before = Vector::Zero(problem.dof_count());
      if (problem.loads.varies()) problem.loads.varying(time, load_before);
    }
    if (problem.loads.varies()) {
      problem.loads.varying(time + h, force_);
      load_ = weights_.force * load_before + (1.0 - weights_.force) * force_;
      load_before = force_;
      corrections_.load_work = load_.dot(work_on_);
    }
    problem.mass.multiply(stages_.change, force_);
    corrections_.numerical_dissipation = less * stages_.motion.dot(force_) + weights_.energy_factor *
                                                                                 (2.0 * weights_.gamma - 1.0) *
                                                                                 stages_.change.dot(force_);
    corrections_.numerical_dissipation += less * elastic_product(problem, stages_.motion, stages_.motion, force_);
    problem.mass.multiply(stages_.mean, force_);
    corrections_.numerical_dissipation += (stages_.jump - (0.5 * h) * impact.increment).dot(force_);
  }

  void store_forces(const SemidiscreteProblem& problem, StageSolve& stages, const StageSolution& impact, State& state) {
    solution_.normal_reaction = impact.normal_reaction / step();
    solution_.support_reaction = stages_.mean_support + impact.support_reaction / step();
    solution_.contact_status = impact.contact_status;
    stages_.equations().store_contact(stages.stage(NonsmoothStages::velocity_stage), solution_, step(), state);
    if (problem.loads.varies()) state.forces.varying_load = load_;
  }

  AlphaWeights weights_;
  NonsmoothStages stages_;
  StepCorrections corrections_;
  Vector load_, work_on_, force_;  ///< F̄ of varying loads; ΔU less the increment; work space
  StageSolution solution_;
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
