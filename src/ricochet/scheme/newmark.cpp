#include "ricochet/scheme/contact_conditions.hpp"
#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

namespace {

/// Newmark's scheme with contact at the end of the step (the source's section 5 with an equivalent mass):
///   M A₁ + C V₁ + K U₁ = L₁ + Gᵀ r_N − B_Tᵀ r_T,   0 ≤ r_N ⟂ g(U₁) ≥ 0,   friction on the slip rate B_T (U₁−U₀)/h,
///   U₁ = U₀ + hV₀ + h²[(½−β)A₀ + βA₁],   V₁ = V₀ + h[(1−γ)A₀ + γA₁]   (textbook β and γ).
/// Unknown x = U₁, base Ũ = U₀ + hV₀ + h²(½−β)A₀, so that A₁ = δ/(βh²).
///
/// Energy: J + ½h²(β−γ/2)AᵀMA changes in a step by ΔUᵀ[(1−γ)F₀+γF₁], with F the forces outside J, less
///   (γ−½)ΔUᵀKΔU + ½h²(β−γ/2)(2γ−1)ΔAᵀMΔA
/// (S. Krenk, Int. J. Numer. Meth. Engng. 67 (2006) 1–16).
///
/// On massless dofs A and V are no states: A = 0, V = ΔU/h. Damping then acts on ΔU/h for all dofs, because a mixture
/// of the two velocities would make the operator unsymmetric.
class Newmark final : public Scheme {
 public:
  explicit Newmark(const SchemeParameters& parameters)
      : Scheme(parameters), beta_(parameters.beta), gamma_(parameters.gamma), alpha_(1.0 / (beta_ * step() * step())) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    return {{alpha_, 1.0, problem.has_singular_mass() ? 1.0 / step() : gamma_ * step() * alpha_}};
  }
  [[nodiscard]] WorkRule work_rule() const override { return {1.0 - gamma_, gamma_}; }

  void prepare(const SemidiscreteProblem& problem, const State& state, int, Stage& stage) override {
    const double h = step();
    predicted_increment_ = h * state.velocity + (h * h * (0.5 - beta_)) * state.acceleration;
    base_ = state.displacement + predicted_increment_;
    problem.internal_force->evaluate(base_, force_);
    problem.loads.total(state.time + h, stage.right_hand_side);
    stage.right_hand_side -= force_;
    if (problem.has_damping()) {
      damping_velocity(problem, state);
      stage.right_hand_side.noalias() -= problem.damping * velocity_;
    }
    problem.supports.values(state.time + h, supported_);
    stage.prescribed.resize(problem.supports.size());
    for (Index i = 0; i < problem.supports.size(); ++i) {
      stage.prescribed[i] = supported_[i] - base_[problem.supports.dofs()[static_cast<std::size_t>(i)]];
    }
    require_no_penetration(problem, base_, state.time + h, stage);
    require_friction_over_step(problem, state, stage);
  }

  void finish(const SemidiscreteProblem& problem, const std::vector<StageSolution>& solutions, State& state,
              Vector& increment) override {
    const double h = step();
    const StageSolution& solution = solutions.front();
    increment = predicted_increment_ + solution.increment;
    acceleration_ = alpha_ * solution.increment;
    for (const Index dof : problem.massless_dofs) acceleration_[dof] = 0.0;
    dissipate(problem, state, increment);
    if (problem.has_damping()) {
      velocity_ += (problem.has_singular_mass() ? 1.0 / h : gamma_ * h * alpha_) * solution.increment;
      state.forces.damping_force.noalias() = problem.damping * velocity_;
    }
    state.displacement += increment;
    state.velocity += h * ((1.0 - gamma_) * state.acceleration + gamma_ * acceleration_);
    state.acceleration = acceleration_;
    for (const Index dof : problem.massless_dofs) state.velocity[dof] = increment[dof] / h;
    take_contact(solution, obstacle_velocity_, h, state);
    if (problem.loads.varies()) problem.loads.varying(state.time + h, state.forces.varying_load);
  }

  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override {
    const double factor = 0.5 * step() * step() * (beta_ - 0.5 * gamma_);
    if (factor == 0.0) return 0.0;
    return factor * problem.mass.form(state.acceleration);
  }

  [[nodiscard]] double numerical_dissipation(const SemidiscreteProblem&) const override { return dissipation_; }

 private:
  /// The velocity that damping acts on, at the base (δ = 0).
  void damping_velocity(const SemidiscreteProblem& problem, const State& state) {
    if (problem.has_singular_mass()) {
      velocity_ = predicted_increment_ / step();
    } else {
      velocity_ = state.velocity + (step() * (1.0 - gamma_)) * state.acceleration;
    }
  }

  void require_friction_over_step(const SemidiscreteProblem& problem, const State& state, Stage& stage) {
    if (problem.has_moving_obstacles()) {
      middle_ = state.displacement + 0.5 * predicted_increment_;
      problem.obstacle_velocity(middle_, state.time + 0.5 * step(), obstacle_velocity_);
    }
    if (!problem.contact.has_friction()) return;
    rate_ = predicted_increment_ / step();
    require_friction(problem, rate_, obstacle_velocity_, 1.0 / step(), stage);
  }

  void dissipate(const SemidiscreteProblem& problem, const State& state, const Vector& increment) {
    dissipation_ = 0.0;
    if (gamma_ == 0.5) return;
    problem.internal_force->evaluate(increment, force_);  // linear: K ΔU
    dissipation_ = (gamma_ - 0.5) * increment.dot(force_);
    difference_ = acceleration_ - state.acceleration;
    dissipation_ +=
        0.5 * step() * step() * (beta_ - 0.5 * gamma_) * (2.0 * gamma_ - 1.0) * problem.mass.form(difference_);
  }

  double beta_, gamma_, alpha_;
  double dissipation_ = 0.0;
  Vector base_, force_, supported_, predicted_increment_, acceleration_, velocity_, difference_, rate_, middle_;
  ObstacleMotion obstacle_velocity_;
};

}  // namespace

std::unique_ptr<Scheme> make_newmark(const SchemeParameters& parameters) {
  return std::make_unique<Newmark>(parameters);
}

}  // namespace ricochet
