#include "ricochet/scheme/reduced/end_contact_scheme.hpp"
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
class ReducedMidpoint final : public EndContactScheme {
 public:
  explicit ReducedMidpoint(double step) : EndContactScheme("reduced-midpoint", step, false) {}

  void analyse(const SemidiscreteProblem& problem) override {
    EndContactScheme::analyse(problem);
    massless_step().require_frictionless_planes(problem);
  }
  [[nodiscard]] ProblemTraits traits_for(const SemidiscreteProblem&) const override { return {}; }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    if (has_finite_strain()) return EndContactScheme::operators(problem);
    std::vector<OperatorCoefficients> result = massless_step().operators(problem, ActingReaction::end);
    result.back().condensed_operator = -1;
    return result;
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    if (has_finite_strain()) return EndContactScheme::advance(problem, state, stages, increment);
    const double h = step(), middle = state.time + 0.5 * h;
    const bool has_contact_nodes = problem.has_contact_dofs();
    const std::size_t number = MasslessContactStep::midpoint_stage(problem);
    Stage& stage = stages.stage(number);
    massless_step().balance(problem, state, stage);
    require_no_penetration(problem, massless_step().base(), middle, stage);
    evaluate_obstacle_velocity(problem, massless_step().base(), {middle, h, 1.0}, stage);
    if (has_contact_nodes) massless_step().find_residual(problem, state);
    const StageSolution& solution = stages.solve(number);
    increment = h * state.velocity + 2.0 * solution.increment;
    copy_result(solution);
    if (has_contact_nodes) solve_end_contact(problem, state, stages, increment);
    massless_step().move(problem, solution.increment, increment, state);
    massless_step().store_forces(problem, stage, result_, increment, state);
    corrections_ = {};
    if (has_contact_nodes)
      corrections_.contact_work =
          -massless_step().contact_node_work(problem, *stage.rows, result_, increment, stages).reactions;
  }
  [[nodiscard]] LastStep last_step() const override {
    LastStep result = EndContactScheme::last_step();
    if (!has_finite_strain()) result.corrections = corrections_;
    return result;
  }

 private:
  [[nodiscard]] ActingReaction acting(const SemidiscreteProblem&) const override { return ActingReaction::path_mean; }
  /// Computes the contact nodes at the end: K_cc δ = L₁ + Gᵀr₁ − (K u)_c, from their predicted displacement.
  void solve_end_contact(const SemidiscreteProblem& problem, const State& state, StageSolve& stages,
                         Vector& increment) {
    for (const Index dof : problem.contact_dofs) increment[dof] = step() * state.velocity[dof];
    massless_step().stiffness().multiply(increment, row_force_);
    Stage& stage = stages.stage(MasslessContactStep::condensed_stage);
    row_force_ = massless_step().residual() + massless_step().load_change() - row_force_;
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

  StepCorrections corrections_;
  StageSolution result_;
  Vector row_force_, base_;
};

}  // namespace

SchemeRegistration reduced_midpoint_scheme() {
  return {"reduced-midpoint", [](double step, const Parameters&) { return std::make_unique<ReducedMidpoint>(step); }};
}

}  // namespace ricochet
