#include "ricochet/scheme/reduced/massless_contact_step.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Midpoint scheme for contact nodes without inertia: contact at the middle of the step determines the motion of the
/// other nodes, and contact nodes are in equilibrium, contact included, at its end:
///   1. A δ = b + Gᵀ r̄,   0 ≤ r̄ ⟂ g(x) ≥ 0,   u_f1 = 2x_f − u_f0   (massless_contact_step.hpp, ρ̄ = r̄);
///   2. K_cc u_c1 + K_cf u_f1 = L₁ + Gᵀ r₁,   0 ≤ r₁ ⟂ g(u₁) ≥ 0.
/// With W_c = G K_cc⁻¹ Gᵀ: E₁ − E₀ = r̄·Δg − (r̄ − ½(r₀+r₁))ᵀW_c(r₁−r₀) + work of loads, supports and obstacles; the
/// first two terms, which are the contact work here, vanish while the set of pressing points is unchanged. The midpoint
/// rule alone would have u_c1 = 2x_c − u_c0, with which contact nodes alternate from step to step.
/// At finite strain the acting reactions are those of mean-reaction, and energy is conserved exactly
/// (finite_strain_step.hpp).
class ReducedMidpoint final : public Scheme {
 public:
  explicit ReducedMidpoint(double step)
      : Scheme(step, {.acting_instant = -0.5,
                      .supports_step_changes = true,
                      .supports_nonlinear_force = true,
                      .supports_relaxation = true,
                      .conserves_moments_at_finite_strain = true,
                      .suits_singular_mass = true,
                      .jump_response = JumpResponse::alternates}),
        massless_step_("reduced-midpoint", step) {}

  void analyse(const SemidiscreteProblem& problem) override {
    massless_step_.analyse(problem);
    massless_step_.require_frictionless_planes(problem);
  }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    if (!problem.internal_force->is_linear()) return massless_step_.operators(problem, mean(problem));
    std::vector<OperatorCoefficients> result = massless_step_.operators(problem, ReactionMean::end);
    result.back().condensed_operator = -1;
    return result;
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    if (!problem.internal_force->is_linear()) {
      massless_step_.advance(problem, mean(problem), state, stages, increment);
      return;
    }
    const double h = step(), middle = state.time + 0.5 * h;
    const bool has_contact_nodes = problem.has_contact_dofs();
    const std::size_t number = MasslessContactStep::midpoint_stage(problem);
    Stage& stage = stages.stage(number);
    massless_step_.balance(problem, state, stage);
    require_no_penetration(problem, massless_step_.base(), middle, stage);
    if (problem.has_moving_obstacles())
      evaluate_obstacle_velocity(problem, massless_step_.base(), {middle, h, 1.0}, stage);
    if (has_contact_nodes) massless_step_.find_residual(problem, state);
    const StageSolution& solution = stages.solve(number);
    increment = h * state.velocity + 2.0 * solution.increment;
    copy_result(solution);
    if (has_contact_nodes) solve_end_contact(problem, state, stages, increment);
    massless_step_.move(problem, solution.increment, increment, state);
    massless_step_.store_forces(problem, stage, result_, increment, state);
    corrections_ = {};
    if (has_contact_nodes)
      corrections_.contact_work =
          -massless_step_.contact_node_work(problem, *stage.rows, result_, increment, stages).reactions;
  }
  [[nodiscard]] LastStep last_step() const override {
    LastStep result = massless_step_.last_step();
    if (!massless_step_.has_finite_strain()) result.corrections = corrections_;
    return result;
  }

 protected:
  void step_changed(const SemidiscreteProblem& problem) override { massless_step_.change_step(problem, step()); }

 private:
  static ReactionMean mean(const SemidiscreteProblem& problem) {
    return !problem.has_contact_dofs() ? ReactionMean::end : ReactionMean::path;
  }
  /// Computes the contact nodes at the end: K_cc δ = L₁ + Gᵀr₁ − (K u)_c, from their predicted displacement.
  void solve_end_contact(const SemidiscreteProblem& problem, const State& state, StageSolve& stages,
                         Vector& increment) {
    for (const Index dof : problem.contact_dofs) increment[dof] = step() * state.velocity[dof];
    massless_step_.stiffness().multiply(increment, row_force_);
    Stage& stage = stages.stage(MasslessContactStep::condensed_stage);
    row_force_ = massless_step_.residual() + massless_step_.load_change() - row_force_;
    MasslessContactStep::set_contact_force(problem, row_force_, stage);
    base_ = state.displacement + increment;
    require_no_penetration(problem, base_, state.time + step(), stage);
    const StageSolution& end = stages.solve(MasslessContactStep::condensed_stage);
    for (const Index dof : problem.contact_dofs) increment[dof] += end.increment[dof];
    result_.normal_reaction = end.normal_reaction;
    result_.contact_status = end.contact_status;
  }

  /// Copies the results of contact at the middle, member by member, so that storage is kept.
  void copy_result(const StageSolution& solution) {
    result_.normal_reaction = solution.normal_reaction;
    result_.mean_normal_reaction = solution.normal_reaction;
    result_.support_reaction = solution.support_reaction;
    result_.contact_status = solution.contact_status;
  }

  MasslessContactStep massless_step_;
  StepCorrections corrections_;
  StageSolution result_;
  Vector row_force_, base_;
};

}  // namespace

SchemeRegistration reduced_midpoint_scheme() {
  return {"reduced-midpoint", [](double step, const Parameters&) { return std::make_unique<ReducedMidpoint>(step); }};
}

}  // namespace ricochet
