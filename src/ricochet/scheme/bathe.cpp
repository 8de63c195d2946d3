#include <array>

#include "ricochet/problem/contact_conditions.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"

namespace ricochet {

namespace {

/// The composite scheme of K.-J. Bathe and M. M. I. Baig (Comput. Struct. 83 (2005) 2513–2524; K.-J. Bathe, Comput.
/// Struct. 85 (2007) 437–445): the trapezoidal rule to the middle of the step, then backward differences of three
/// points, with contact at both,
///   1. M A_½ + C V_½ + K U_½ = L_½ + F_½,   V_½ = V₀ + (h/4)(A₀+A_½),   U_½ = U₀ + (h/4)(V₀+V_½);
///   2. M A₁ + C V₁ + K U₁ = L₁ + F₁,   V₁ = (U₀−4U_½+3U₁)/h,   A₁ = (V₀−4V_½+3V₁)/h;
/// F = Gᵀ r_N − B_Tᵀ r_T with Signorini's conditions at each of the two, and friction on the slip rates
/// B_T (U_½−U₀)/(h/2) and B_T V₁. Bases Ũ = U₀ + (h/2)V₀ + (h²/16)A₀ and (4U_½−U₀)/3 + (h/9)(4V_½−V₀), so that
/// A_½ = (16/h²) δ and A₁ = (9/h²) δ.
///
/// With Δ₁ = U_½−U₀, Δ₂ = U₁−U_½ and hV₁ = 3Δ₂−Δ₁, J changes in a step by ⅓(F₀+F_½)ᵀ(3Δ₁/2+hV₁/4) + ⅓F₁ᵀhV₁, F the
/// forces outside J, less
///   ½|Δ₂|²_K + ½|V₁−V_½|²_M − ⅓Δ₁ᵀ(KU₁−L) + (h/12)V₁ᵀ(KU₀+KU_½−2L),
/// which has no sign; momentum by ⅓h(F₀+F_½+F₁). On massless dofs the velocity of the middle is 2Δ₁/h.
class Bathe final : public Scheme {
 public:
  using Scheme::Scheme;

  [[nodiscard]] bool changes_step() const override { return true; }
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    const double h = step();
    return {{16.0 / (h * h), 1.0, (problem.has_singular_mass() ? 2.0 : 4.0) / h}, {9.0 / (h * h), 1.0, 3.0 / h}};
  }
  [[nodiscard]] WorkRule work_rule() const override { return {0.0, 1.0 / 3.0}; }
  [[nodiscard]] bool suits_singular_mass() const override { return true; }
  [[nodiscard]] StepCorrections step_corrections(const SemidiscreteProblem&) const override {
    return {.numerical_dissipation = dissipation_};
  }
  [[nodiscard]] std::span<const StepPart> other_parts() const override { return parts_; }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step();
    go_to_middle(problem, state, stages);
    second_ = first_ / 3.0 + (h / 9.0) * (4.0 * velocity_ - state.velocity);  // at δ = 0
    rate_ = (4.0 * velocity_ - state.velocity) / 3.0;                         // V₁ at δ = 0
    Stage& stage = stages.stage(1);
    middle_ = state.displacement + first_;
    base_ = middle_ + second_;
    equations_.balance(problem, state.time + h, base_, rate_, stage);
    const auto to_end = [&](Index dof, double end) { return end - base_[dof]; };
    equations_.prescribe(problem, state.time + h, to_end, stage);
    require_no_penetration(problem, base_, state.time + h, stage);
    if (problem.has_moving_obstacles()) equations_.observe_obstacles(problem, state.time + h, base_);
    equations_.require_friction(problem, rate_, 3.0 / h, stage);

    const StageSolution& solution = stages.solve(1);
    second_ += solution.increment;            // U₁ − U_½
    rate_ += (3.0 / h) * solution.increment;  // V₁
    dissipate(problem, state);
    increment = 3.0 * second_ - first_;
    take_first_forces(problem, state, stages);
    state.displacement = middle_ + second_;
    state.velocity = rate_;
    state.acceleration = (9.0 / (h * h)) * solution.increment;
    for (const Index dof : problem.massless_dofs) {
      state.velocity[dof] = (first_[dof] + second_[dof]) / h;
      state.acceleration[dof] = 0.0;
    }
    equations_.take_forces(problem, stage, solution, h, rate_, 1.0, state);
  }

 private:
  /// Δ₁ and V_½.
  void go_to_middle(const SemidiscreteProblem& problem, const State& state, StageSolve& stages) {
    const double h = step(), time = state.time + 0.5 * h;
    first_ = (0.5 * h) * state.velocity + (h * h / 16.0) * state.acceleration;
    velocity_ = state.velocity + (0.25 * h) * state.acceleration;
    for (const Index dof : problem.massless_dofs) velocity_[dof] = first_[dof] / (0.5 * h);
    base_ = state.displacement + first_;
    Stage& stage = stages.stage(0);
    middle_equations_.balance(problem, time, base_, damped_velocity(problem), stage);
    const auto to_middle = [&](Index dof, double middle) { return middle - base_[dof]; };
    middle_equations_.prescribe(problem, time, to_middle, stage);
    require_no_penetration(problem, base_, time, stage);
    middle_equations_.require_friction_over_step(problem, state, first_, 0.5 * h, stage);
    middle_solution_ = &stages.solve(0);
    first_ += middle_solution_->increment;
    velocity_ += (4.0 / h) * middle_solution_->increment;
    for (const Index dof : problem.massless_dofs) velocity_[dof] = first_[dof] / (0.5 * h);
  }

  /// Damping acts on mean velocities where there are massless dofs, as under newmark.
  const Vector& damped_velocity(const SemidiscreteProblem& problem) {
    if (!problem.has_singular_mass()) return velocity_;
    mean_velocity_ = first_ / (0.5 * step());
    return mean_velocity_;
  }

  void dissipate(const SemidiscreteProblem& problem, const State& state) {
    const Vector& load = problem.loads.constant();
    const InternalForce& internal = *problem.internal_force;  // linear: K times its argument
    internal.evaluate(second_, force_);
    dissipation_ = 0.5 * second_.dot(force_);
    change_ = rate_ - velocity_;
    dissipation_ += 0.5 * problem.mass.form(change_);
    change_ = middle_ + second_;
    internal.evaluate(change_, force_);
    dissipation_ -= (first_.dot(force_) - first_.dot(load)) / 3.0;
    change_ = state.displacement + middle_;
    internal.evaluate(change_, force_);
    dissipation_ += step() / 12.0 * (rate_.dot(force_) - 2.0 * rate_.dot(load));
  }

  /// Those of the start and the middle, before the state has those of the end.
  void take_first_forces(const SemidiscreteProblem& problem, const State& state, StageSolve& stages) {
    StepPart &start = parts_[0], &middle = parts_[1];
    start.forces = state.forces;
    start.weight = middle.weight = 1.0 / 3.0;
    start.increment = middle.increment = 1.5 * first_ + (0.25 * step()) * rate_;
    middle_equations_.take_part(problem, stages.stage(0), *middle_solution_, step(), damped_velocity(problem), 1.0,
                                middle);
    start.obstacle_increment = middle.obstacle_increment;
  }

  double dissipation_ = 0.0;
  std::array<StepPart, 2> parts_;
  Vector first_, second_, velocity_, mean_velocity_, rate_, base_, middle_, force_, change_;
  StepEquations equations_, middle_equations_;
  const StageSolution* middle_solution_ = nullptr;
};

}  // namespace

SchemeRegistration bathe_scheme() {
  return {"bathe", [](double step, const Parameters&) { return std::make_unique<Bathe>(step); }};
}

}  // namespace ricochet
