#include <array>

#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Composite scheme of K.-J. Bathe and M. M. I. Baig (Comput. Struct. 83 (2005) 2513–2524; K.-J. Bathe, Comput. Struct.
/// 85 (2007) 437–445): the trapezoidal rule to the middle of the step, then three-point backward differences, with
/// contact at both instants. With Δ₁ = U_½−U₀, Δ₂ = U₁−U_½, F the forces outside J,
///   M A + C V + K U = L + F at ½ and 1,   V₁ = (3Δ₂−Δ₁)/h,   A₁ = (V₀−4V_½+3V₁)/h,   slip rates B_T 2Δ₁/h and B_T V₁.
/// Bases U₀ + (h/2)V₀ + (h²/16)A₀ and U_½ + Δ₁/3 + (h/9)(4V_½−V₀), so that A_½ = (16/h²) δ, A₁ = (9/h²) δ. J changes by
/// ⅓(F₀+F_½)ᵀ(3Δ₁/2+hV₁/4) + ⅓F₁ᵀhV₁, less ½|Δ₂|²_K + ½|V₁−V_½|²_M − ⅓Δ₁ᵀ(KU₁−L) + (h/12)V₁ᵀ(KU₀+KU_½−2L), which has no
/// sign; the momentum changes by ⅓h(F₀+F_½+F₁). On massless dofs the velocity of the middle is 2Δ₁/h.
class Bathe final : public Scheme {
 public:
  explicit Bathe(double step)
      : Scheme(step, {.work_rule = {0.0, 1.0 / 3.0}, .supports_step_changes = true, .suits_singular_mass = true}) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    const double h = step();
    return {{16.0 / (h * h), 1.0, damping_factor(problem)}, {9.0 / (h * h), 1.0, 3.0 / h}};
  }
  [[nodiscard]] LastStep last_step() const override {
    return {.corrections = {.numerical_dissipation = dissipation_}, .other_stages = parts_};
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double h = step();
    go_to_middle(problem, state, stages);
    second_ = first_ / 3.0 + (h / 9.0) * (4.0 * velocity_ - state.velocity);  // at δ = 0
    rate_ = (4.0 * velocity_ - state.velocity) / 3.0;                         // V₁ at δ = 0
    middle_ = state.displacement + first_;
    end_base_ = middle_ + second_;
    Stage& stage = stages.stage(1);
    equations_.balance(problem, state.time + h, end_base_, rate_, stage);
    equations_.prescribe_from(problem, state.time + h, end_base_, stage);
    require_no_penetration(problem, end_base_, state.time + h, stage);
    evaluate_obstacle_velocity(problem, end_base_, {state.time + h, 0.0, 1.0}, stage);
    require_friction(problem, rate_, 3.0 / h, stage);
    const StageSolution& solution = stages.solve(1);
    second_ += solution.increment;            // U₁ − U_½
    rate_ += (3.0 / h) * solution.increment;  // V₁
    compute_dissipation(problem, state);
    increment = 3.0 * second_ - first_;
    store_initial_forces(problem, state, stages);
    state.displacement = middle_ + second_;
    state.velocity = rate_;
    state.acceleration = (9.0 / (h * h)) * solution.increment;
    total_increment_ = first_ + second_;
    follow_without_inertia(problem, total_increment_, h, state);
    equations_.store_forces(problem, stage, solution, h, rate_, 1.0, state);
  }

 private:
  /// Damping factor of the middle. Damping acts on mean velocities if there are massless dofs, as under newmark.
  [[nodiscard]] double damping_factor(const SemidiscreteProblem& problem) const {
    return (problem.has_singular_mass() ? 2.0 : 4.0) / step();
  }

  /// Computes Δ₁ and V_½.
  void go_to_middle(const SemidiscreteProblem& problem, const State& state, StageSolve& stages) {
    const double h = step(), time = state.time + 0.5 * h;
    first_ = (0.5 * h) * state.velocity + (h * h / 16.0) * state.acceleration;
    velocity_ = state.velocity + (0.25 * h) * state.acceleration;
    damped_ = problem.has_singular_mass() ? (2.0 / h) * first_ : 1.0 * velocity_;
    middle_base_ = state.displacement + first_;
    Stage& stage = stages.stage(0);
    middle_equations_.balance(problem, time, middle_base_, damped_, stage);
    middle_equations_.prescribe_from(problem, time, middle_base_, stage);
    require_no_penetration(problem, middle_base_, time, stage);
    middle_equations_.require_friction_over_step(problem, state, first_, 0.5 * h, stage);
    middle_solution_ = &stages.solve(0);
    first_ += middle_solution_->increment;
    velocity_ += (4.0 / h) * middle_solution_->increment;
    damped_ += damping_factor(problem) * middle_solution_->increment;
    for (const Index dof : problem.massless_dofs) velocity_[dof] = first_[dof] / (0.5 * h);
  }

  void compute_dissipation(const SemidiscreteProblem& problem, const State& state) {
    const Vector& load = problem.loads.constant();
    velocity_change_ = rate_ - velocity_;
    dissipation_ =
        0.5 * (elastic_product(problem, second_, second_, force_) + problem.mass.quadratic_form(velocity_change_));
    end_displacement_ = middle_ + second_;
    dissipation_ -= (elastic_product(problem, end_displacement_, first_, force_) - first_.dot(load)) / 3.0;
    displacement_sum_ = state.displacement + middle_;
    dissipation_ +=
        step() / 12.0 * (elastic_product(problem, displacement_sum_, rate_, force_) - 2.0 * rate_.dot(load));
  }

  /// Stores the forces of the start and the middle, before the state receives those of the end.
  void store_initial_forces(const SemidiscreteProblem& problem, const State& state, StageSolve& stages) {
    OtherStageForces &start = parts_[0], &middle = parts_[1];
    start.forces = state.forces;
    start.weight = middle.weight = 1.0 / 3.0;
    start.increment = middle.increment = 1.5 * first_ + (0.25 * step()) * rate_;
    middle_equations_.store_other_stage(problem, stages.stage(0), *middle_solution_, step(), damped_, 1.0, middle);
    start.obstacle_increment = middle.obstacle_increment;
  }

  double dissipation_ = 0.0;
  std::array<OtherStageForces, 2> parts_;
  Vector first_, second_, velocity_, damped_, rate_, middle_base_, end_base_, middle_, force_, total_increment_,
      velocity_change_, end_displacement_, displacement_sum_;
  StepEquations equations_, middle_equations_;
  const StageSolution* middle_solution_ = nullptr;
};

}  // namespace

SchemeRegistration bathe_scheme() {
  return {"bathe", [](double step, const Parameters&) { return std::make_unique<Bathe>(step); }};
}

}  // namespace ricochet
