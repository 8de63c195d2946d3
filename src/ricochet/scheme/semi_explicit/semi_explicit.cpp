#include "ricochet/scheme/critical_step.hpp"
#include "ricochet/scheme/requirements.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/semi_explicit/contact_equilibrium.hpp"
#include "ricochet/scheme/semi_explicit/explicit_motion.hpp"
#include "ricochet/scheme/semi_explicit/requirements.hpp"
#include "ricochet/scheme/semi_explicit/supported_motion.hpp"

namespace ricochet {

namespace {

/// Key of State::memory: K U at the state.
constexpr const char* force_memory = "internal_force";

/// Central differences inside, contact nodes without inertia at the end of the step (D. Doyen, A. Ern, S. Piperno, SIAM
/// J. Sci. Comput. 33 (2011) 223–249). The mass is diagonal and zero on the contact nodes (index c; i: all others):
///   M_ii A + C_ii V + K_ii u_i + K_ic u_c = L_i   and   K_cc u_c + K_ci u_i = L_c + Gᵀr_N − B_Tᵀr_T   at every t_n,
///   V^{n+½} = (U^{n+1}−Uⁿ)/h,   V^{n±½} = Vⁿ ± (h/2)Aⁿ,   0 ≤ r_N ⟂ g(U^{n+1}) ≥ 0,   friction on B_T (U^{n+1}−Uⁿ)/h.
/// So u_i^{n+1} needs no system, and then u_c^{n+1} and the reactions come from the stage on the contact dofs alone.
///
/// In terms of Uⁿ, Vⁿ, Aⁿ this is Newmark's scheme with β = 0, γ = ½, and its account holds: J − (h²/8)AᵀMA changes in
/// a step by ½ΔUᵀ(F₀+F₁), F the forces outside J. The same balance at half steps, for V^{n+½} and the elastic energy
/// ½(Uⁿ)ᵀKU^{n+1}, gains ½r_Nⁿ·(g^{n+1}−g^{n−1}) from contact.
///
/// Stable for h < 2/√λ, λ the largest eigenvalue of M_ii⁻¹K_ii; see critical_step.hpp.
///
/// One product with K in a step, and one with its contact rows.
class SemiExplicit final : public Scheme {
 public:
  explicit SemiExplicit(double step, bool at_any_step = false) : Scheme(step), at_any_step_(at_any_step) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    if (problem.contact_dofs.empty()) return {};
    return {{0.0, 1.0, 0.0, StageDofs::contact}};
  }
  [[nodiscard]] WorkRule work_rule() const override { return {0.5, 0.5}; }
  [[nodiscard]] double critical_step() const override { return critical_step_; }
  [[nodiscard]] long history_every() const override { return 2; }
  [[nodiscard]] bool suits_singular_mass() const override { return true; }
  [[nodiscard]] std::optional<double> stability_limit(const SemidiscreteProblem& problem) const override {
    return problem.mass.is_diagonal() ? std::optional(central_difference_limit(problem)) : std::nullopt;
  }

  void analyse(const SemidiscreteProblem& problem) override {
    require_semi_explicit(problem, "semi-explicit");
    critical_step_ = central_difference_limit(problem);
    if (!at_any_step_) check_critical_step("semi-explicit", step(), critical_step_);
    motion_.analyse(problem, step());
    contact_.analyse(problem);
  }

  void start(const SemidiscreteProblem& problem, State& state, StageSolve&) override {
    problem.internal_force->evaluate(state.displacement, state.memory[force_memory]);
    start_supports(problem, motion_.mass(), step(), state);
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step();
    evaluate_loads(problem, state.time + h);
    const StageSolution* const solution = solve_contact(problem, state, stages);
    motion_.move(problem, solution != nullptr ? solution->increment : no_correction_, h, state, increment);
    problem.internal_force->evaluate(state.displacement, state.memory.at(force_memory));
    motion_.accelerate(state.memory.at(force_memory), load(problem), h, state);
    if (solution != nullptr) equations_.take_contact(stages.stage(0), *solution, h, state);
    supports_.advance(problem, motion_.mass(), motion_.damping(), state.memory.at(force_memory), load(problem),
                      increment, h, state);
    for (const Index dof : problem.massless_dofs) state.velocity[dof] = increment[dof] / h;
    if (problem.loads.varies()) state.forces.varying_load = varying_;
    if (problem.has_damping()) state.forces.damping_force = motion_.damping().cwiseProduct(state.velocity);
  }

  [[nodiscard]] const Vector* internal_force(const State& state) const override {
    return &state.memory.at(force_memory);
  }

  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem&, const State& state) const override {
    return -0.125 * step() * step() * state.acceleration.dot(motion_.mass().cwiseProduct(state.acceleration));
  }

 private:
  /// None where there is no contact dof.
  const StageSolution* solve_contact(const SemidiscreteProblem& problem, const State& state, StageSolve& stages) {
    if (problem.contact_dofs.empty()) return nullptr;
    contact_.require(problem, state, state.memory.at(force_memory), load(problem), state.memory.at(supported_next),
                     step(), equations_, stages.stage(0));
    return &stages.solve(0);
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
  SupportedMotion supports_{contact_.contact_node_dofs()};
  StepEquations equations_;
};

}  // namespace

std::unique_ptr<Scheme> make_semi_explicit_at_any_step(double step) {
  return std::make_unique<SemiExplicit>(step, true);
}

SchemeRegistration semi_explicit_scheme() {
  return {"semi-explicit", [](double step, const Parameters&) { return std::make_unique<SemiExplicit>(step); }};
}

}  // namespace ricochet
