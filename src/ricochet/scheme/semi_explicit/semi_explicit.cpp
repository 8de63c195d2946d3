#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/scheme/critical_step.hpp"
#include "ricochet/scheme/requirements.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/semi_explicit/contact_equilibrium.hpp"
#include "ricochet/scheme/semi_explicit/explicit_motion.hpp"
#include "ricochet/scheme/semi_explicit/nonlinear_contact_equilibrium.hpp"
#include "ricochet/scheme/semi_explicit/requirements.hpp"
#include "ricochet/scheme/semi_explicit/supported_motion.hpp"
#include "ricochet/scheme/semi_explicit/tracked_critical_step.hpp"
#include "ricochet/scheme/step_equations.hpp"

namespace ricochet {

namespace {

/// Key of State::memory: the internal force at the state.
constexpr const char* force_memory = "internal_force";

/// Central differences inside, contact nodes without inertia in equilibrium at the end of the step (D. Doyen, A. Ern,
/// S. Piperno, SIAM J. Sci. Comput. 33 (2011) 223–249). The mass is diagonal and zero on the contact nodes (index c; i:
/// all others):
///   M_ii A + C_ii V + K_ii u_i + K_ic u_c = L_i   and   K_cc u_c + K_ci u_i = L_c + Gᵀr_N − B_Tᵀr_T   at every t_n,
///   V^{n+½} = (U^{n+1}−Uⁿ)/h,   V^{n±½} = Vⁿ ± (h/2)Aⁿ,   0 ≤ r_N ⟂ g(U^{n+1}) ≥ 0,   friction on B_T (U^{n+1}−Uⁿ)/h.
/// So u_i^{n+1} requires no system, and then u_c^{n+1} and the reactions follow from the stage on the contact dofs
/// alone.
///
/// In terms of Uⁿ, Vⁿ, Aⁿ this is Newmark's scheme with β = 0, γ = ½, and its energy balance holds: in a step
/// J − (h²/8)AᵀMA changes by ½ΔUᵀ(F₀+F₁), F the forces outside J. The balance at half steps, for V^{n+½} and the
/// elastic energy ½(Uⁿ)ᵀKU^{n+1}, gains ½r_Nⁿ·(g^{n+1}−g^{n−1}) from contact.
///
/// Stable for h < 2/√λ, λ the largest eigenvalue of M_ii⁻¹K_ii; see critical_step.hpp.
///
/// A step performs one product with K, and one with its contact rows.
///
/// For an internal force f = ∂W/∂u that is nonlinear in the displacement (finite strain) f_i(U) and f_c(U) replace the
/// products, the contact nodes' equilibrium requires Newton's method (nonlinear_contact_equilibrium.hpp), and a step
/// one evaluation of f and one of W. The body without its contact nodes has the potential Ψ(u_i) = min over admissible
/// u_c of W − L·u, and this is the Störmer–Verlet scheme for it, so that
/// - energy: in a step J − (h²/8)AᵀMA changes by ½ΔUᵀ(F₀+F₁) and by ΔW − ½ΔUᵀ(f₀+f₁) (`integration_error`), of order h³
/// and of either sign: in flight it oscillates and does not accumulate, which is no proof of a bound;
/// - momenta: ΔU = hV^{n+½} has no moment with V^{n+½}, and f has no resultant and no moment about the current
/// positions, so Σ m x×V changes in a step by (h/2)(N₀+N₁), N the moment of all external forces about the positions at
/// their instant: exactly, as the resultant does.
/// The critical step changes with the deformation (tracked_critical_step.hpp): it is tracked, and a step beyond it is
/// not taken.
class SemiExplicit final : public Scheme {
 public:
  explicit SemiExplicit(double step, bool at_any_step = false)
      : Scheme(step, {.work_rule = {0.5, 0.5},
                      .history_every = 2,
                      .supports_nonlinear_force = true,
                      .conserves_moments_at_finite_strain = true,
                      .suits_singular_mass = true}),
        at_any_step_(at_any_step) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    if (!problem.has_contact_dofs()) return {};
    return {{0.0, 1.0, 0.0, StageDofs::contact}};
  }
  [[nodiscard]] double critical_step() const override { return tracked_ ? tracked_->smallest() : critical_step_; }
  [[nodiscard]] std::optional<double> stability_limit(const SemidiscreteProblem& problem) const override {
    return problem.has_diagonal_mass() ? std::optional(central_difference_limit(problem)) : std::nullopt;
  }

  void analyse(const SemidiscreteProblem& problem) override {
    require_semi_explicit(problem, "semi-explicit");
    critical_step_ = central_difference_limit(problem);
    if (!at_any_step_) check_critical_step("semi-explicit", step(), critical_step_);
    motion_.analyse(problem, step());
    contact_.analyse(problem);
    tracked_.reset();
    if (problem.internal_force->is_linear()) return;
    nonlinear_contact_.analyse(problem);
    tracked_.emplace("semi-explicit");
    tracked_->analyse(problem, critical_step_);
  }

  void start(const SemidiscreteProblem& problem, State& state, StageSolve&) override {
    problem.internal_force->evaluate(state.displacement, state.memory[force_memory]);
    start_supports(problem, motion_.mass(), step(), state);
    if (!tracked_) return;
    tracked_->start(problem, step(), !at_any_step_, state);
    nonlinear_contact_.start(state);
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step();
    evaluate_loads(problem, state.time + h);
    if (tracked_) {
      advance_finite(problem, state, stages, increment);
    } else {
      const StageSolution* const solution = solve_contact(problem, state, stages);
      motion_.move(problem, solution != nullptr ? solution->increment : no_correction_, h, state, increment);
      problem.internal_force->evaluate(state.displacement, force_of(state));
      motion_.accelerate(force_of(state), load(problem), h, state);
      if (solution != nullptr) StepEquations::store_contact(stages.stage(0), *solution, h, state);
    }
    supports_.advance(problem, motion_.mass(), motion_.damping(), force_of(state), load(problem), increment, h, state);
    for (const Index dof : problem.massless_dofs) state.velocity[dof] = increment[dof] / h;
    if (problem.loads.varies()) state.forces.varying_load = varying_;
    if (problem.has_damping()) state.forces.damping_force = motion_.damping().cwiseProduct(state.velocity);
    if (!tracked_) return;
    nonlinear_contact_.renew_where_slow(problem, state, stages);
    if (!at_any_step_) tracked_->track(problem, h, force_of(state), energy_, state);
  }

  [[nodiscard]] LastStep last_step() const override {
    return {.corrections = {.integration_error = integration_error_}, .displacement_of_forces = &end_};
  }

  [[nodiscard]] const Vector* internal_force(const State& state) const override { return &force_of(state); }

  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem&, const State& state) const override {
    return -0.125 * step() * step() * state.acceleration.dot(motion_.mass().cwiseProduct(state.acceleration));
  }

 private:
  /// Returns the internal force at the displacement of the state.
  static Vector& force_of(State& state) { return state.dof_memory(force_memory); }
  static const Vector& force_of(const State& state) { return state.dof_memory(force_memory); }

  /// Returns null without contact dofs.
  const StageSolution* solve_contact(const SemidiscreteProblem& problem, const State& state, StageSolve& stages) {
    if (!problem.has_contact_dofs()) return nullptr;
    contact_.require(problem, state, force_of(state), load(problem),
                     state.memory.at(supported_next, problem.supports.size()), step(), stages.stage(0));
    return &stages.solve(0);
  }

  /// Computes displacement, increment, force and acceleration at the end of the step, and the reactions. The state
  /// changes only when all of them are known.
  void advance_finite(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) {
    const double h = step();
    if (!at_any_step_) tracked_->require_stable(problem, h, state);
    Vector& force = force_of(state);
    if (energy_step_ != state.step) energy_ = problem.internal_force->energy(state.displacement);
    energy_step_ = -1;
    const StageSolution* solution = nullptr;
    try {
      motion_.predict(problem, h, state, increment);
      end_ = state.displacement + increment;
      solution = nonlinear_contact_.solve(problem, state, load(problem), h, stages, increment, end_);
      problem.internal_force->evaluate(end_, force_);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      throw Error(error.kind(), fmt::format("{}; {}", error.what(), tracked_->explain(problem, h, state)));
    }
    const double before = energy_;
    energy_ = problem.internal_force->energy(end_);
    energy_step_ = state.step + 1;
    integration_error_ = (energy_ - before) - 0.5 * (increment.dot(force) + increment.dot(force_));
    state.velocity += (0.5 * h) * state.acceleration;
    state.displacement = end_;
    force = force_;
    motion_.accelerate(force, load(problem), h, state);
    if (solution != nullptr) StepEquations::store_contact(stages.stage(0), *solution, h, state);
  }

  void evaluate_loads(const SemidiscreteProblem& problem, double time) {
    if (!problem.loads.varies()) return;
    problem.loads.varying(time, varying_);
    load_ = problem.loads.constant() + varying_;
  }
  [[nodiscard]] const Vector& load(const SemidiscreteProblem& problem) const {
    return problem.loads.varies() ? load_ : problem.loads.constant();
  }

  bool at_any_step_;
  double critical_step_ = std::numeric_limits<double>::infinity();
  Vector varying_, load_;
  const Vector no_correction_;
  ExplicitMotion motion_;
  ContactEquilibrium contact_;
  // At finite strain:
  std::optional<TrackedCriticalStep> tracked_;
  NonlinearContactEquilibrium nonlinear_contact_;
  Vector end_, force_;     ///< displacement at the end of the last step, and the internal force there
  long energy_step_ = -1;  ///< step whose end energy_ belongs to
  double energy_ = 0.0, integration_error_ = 0.0;
  SupportedMotion supports_{contact_.contact_node_dofs()};
};

}  // namespace

std::unique_ptr<Scheme> make_semi_explicit_at_any_step(double step) {
  return std::make_unique<SemiExplicit>(step, true);
}

SchemeRegistration semi_explicit_scheme() {
  return {"semi-explicit", [](double step, const Parameters&) { return std::make_unique<SemiExplicit>(step); }};
}

}  // namespace ricochet
