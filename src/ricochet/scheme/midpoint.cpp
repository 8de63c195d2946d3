#include "ricochet/scheme/contact_conditions.hpp"
#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

namespace {

/// The midpoint scheme of the source's section 3, with the contact condition at the midpoint:
///   M (V₁−V₀)/h + C V_½ + K U_½ = L_½ + Gᵀ r_N − B_Tᵀ r_T,   U_½ = (U₀+U₁)/2,   V_½ = (V₀+V₁)/2 = (U₁−U₀)/h,
///   0 ≤ r_N ⟂ g(U_½) ≥ 0,   friction on the slip rate B_T V_½.
/// Unknown x = U_½, base U₀ + (h/2)V₀, so that M (V₁−V₀)/h = (4/h²) M δ.
/// Away from contact it conserves energy; with contact its energy changes by (U₁−U₀)ᵀGᵀr of either sign, which
/// multiplies it by hundreds and does not vanish as h → 0: it is here to show that.
class Midpoint final : public Scheme {
 public:
  using Scheme::Scheme;

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    const double h = step();
    return {{4.0 / (h * h), 1.0, 2.0 / h, StageDofs::all}};
  }
  [[nodiscard]] double force_instant() const override { return -0.5; }

  void prepare(const SemidiscreteProblem& problem, const State& state, int, Stage& stage) override {
    const double h = step();
    base_ = state.displacement + (0.5 * h) * state.velocity;
    problem.internal_force->evaluate(base_, force_);
    problem.loads.total(state.time + 0.5 * h, stage.right_hand_side);
    stage.right_hand_side -= force_;
    // C V_½ = (2/h) C (x − U₀) = (2/h) C δ + C V₀.
    if (problem.has_damping()) stage.right_hand_side.noalias() -= problem.damping * state.velocity;
    problem.supports.values(state.time + h, supported_);
    stage.prescribed.resize(problem.supports.size());
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      stage.prescribed[i] = 0.5 * (state.displacement[dof] + supported_[i]) - base_[dof];
    }
    require_no_penetration(problem, base_, state.time + 0.5 * h, stage);
    // V_½ = V₀ + (2/h) δ, also where there is no inertia: V is ΔU/h there, and 2(x − U₀)/h = ΔU/h.
    problem.obstacle_velocity(base_, state.time + 0.5 * h, obstacle_velocity_);
    require_friction(problem, state.velocity, obstacle_velocity_, 2.0 / h, stage);
  }

  void finish(const SemidiscreteProblem& problem, const std::vector<StageSolution>& solutions, State& state,
              Vector& increment) override {
    const double h = step();
    const StageSolution& solution = solutions.front();
    increment = h * state.velocity + 2.0 * solution.increment;  // 2 (x − U₀)
    state.displacement += increment;
    state.velocity += (4.0 / h) * solution.increment;           // 2 (U₁−U₀)/h − V₀
    state.acceleration = (4.0 / (h * h)) * solution.increment;  // (V₁−V₀)/h
    for (const Index dof : problem.massless_dofs) {
      state.velocity[dof] = increment[dof] / h;
      state.acceleration[dof] = 0.0;
    }
    take_contact(solution, obstacle_velocity_, h, state);
    if (problem.loads.varies()) problem.loads.varying(state.time + 0.5 * h, state.forces.varying_load);
    if (problem.has_damping()) state.forces.damping_force.noalias() = problem.damping * increment * (1.0 / h);
  }

 private:
  Vector base_, force_, supported_;
  ObstacleMotion obstacle_velocity_;
};

}  // namespace

std::unique_ptr<Scheme> make_midpoint(const SchemeParameters& parameters) {
  return std::make_unique<Midpoint>(parameters);
}

}  // namespace ricochet
