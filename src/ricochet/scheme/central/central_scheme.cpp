#include "ricochet/scheme/central/central_scheme.hpp"

#include "ricochet/scheme/critical_step.hpp"
#include "ricochet/scheme/requirements.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Key of State::memory: Uⁿ⁺¹ − Uⁿ.
constexpr const char* increment_ahead = "increment_ahead";

}  // namespace

std::optional<double> CentralScheme::stability_limit(const SemidiscreteProblem& problem) const {
  if (stiffness_ != 0.0 || problem.has_singular_mass() || !problem.has_diagonal_mass()) return std::nullopt;
  return central_difference_limit(problem);
}

void CentralScheme::analyse(const SemidiscreteProblem& problem) {
  if (stiffness_ != 0.0) return require_contact_inertia(problem, name_, without_inertia_);
  require_explicit(problem, name_);
  critical_step_ = central_difference_limit(problem);
  check_critical_step(name_, step(), critical_step_);
}

void CentralScheme::start(const SemidiscreteProblem& problem, State& state, StageSolve&) {
  const double h = step();
  Vector& ahead = state.memory[increment_ahead];
  ahead = h * state.velocity + (0.5 * h * h) * state.acceleration;
  const auto to_first = [&](Index dof, double first) { return ahead[dof] = first - state.displacement[dof]; };
  equations_.prescribe(problem, h, to_first, supported_);
}

void CentralScheme::advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) {
  const double h = step(), time = state.time + h;
  Vector& ahead = state.dof_memory(increment_ahead);  // Uⁿ − Uⁿ⁻¹
  now_ = state.displacement + ahead;                  // Uⁿ; the state is at n−1
  velocity_ = ahead / h;
  Stage& stage = stages.stage(0);
  equations_.balance(problem, time, now_, velocity_, stage);  // Vⁿ = (Uⁿ−Uⁿ⁻¹)/h + δ/2h
  const auto to_next = [&](Index dof, double next) { return next - (now_[dof] + ahead[dof]); };
  equations_.prescribe(problem, time + h, to_next, stage);
  evaluate_obstacle_velocity(problem, now_, {time, 2.0 * h}, stage);
  require_contact(problem, {time, state, now_, ahead, velocity_}, stage);

  const StageSolution& solution = stages.solve(0);
  state.displacement += ahead;
  increment = ahead + 0.5 * solution.increment;  // (Uⁿ⁺¹−Uⁿ⁻¹)/2
  ahead += solution.increment;
  state.velocity = increment / h;
  state.acceleration = solution.increment / (h * h);
  equations_.store_forces(problem, stage, solution, h, state.velocity, 1.0, state);
}

/// Changes the coming increment, too: the velocity is that of the step ahead.
void CentralScheme::change_velocity(State& state, const Vector& change) const {
  state.velocity += change;
  state.dof_memory(increment_ahead) += step() * change;
}

void CentralScheme::energy_state(const State& state, Vector& displacement, Vector& velocity) const {
  const Vector& ahead = state.dof_memory(increment_ahead);
  displacement = state.displacement + 0.5 * ahead;
  velocity = ahead / step();
}

double CentralScheme::algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const {
  if (stiffness_ == 0.25) return 0.0;
  const Vector& ahead = state.dof_memory(increment_ahead);
  return 0.5 * (stiffness_ - 0.25) * elastic_product(problem, ahead, ahead, force_);
}

}  // namespace ricochet
