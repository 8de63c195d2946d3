#include "ricochet/scheme/kane.hpp"

#include "ricochet/scheme/requirements.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

void Kane::analyse(const SemidiscreteProblem& problem) {
  require_contact_inertia(problem, name_, "without it they flip from step to step");
}

Stage& Kane::balance(const SemidiscreteProblem& problem, const State& state, StageSolve& stages) {
  const double h = step();
  predicted_ = h * state.velocity;
  base_ = state.displacement + predicted_;
  middle_ = state.displacement + 0.5 * predicted_;
  Stage& stage = stages.stage(0);
  equations_.balance(problem, state.time + 0.5 * h, middle_, state.velocity, stage);
  equations_.prescribe_from(problem, state.time + h, base_, stage);
  return stage;
}

void Kane::require_contact(const SemidiscreteProblem& problem, const State& state, Stage& stage) {
  const StepStart start{state.displacement, state.time};
  require_no_penetration(problem, base_, state.time + step(), stage, &start);
  equations_.require_friction_over_step(problem, state, predicted_, step(), stage);
}

void Kane::advance_state(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution,
                         State& state, Vector& increment) {
  const double h = step();
  increment = predicted_ + solution.increment;
  integration_error_ = error_.of_step(problem, state, increment);
  state.displacement += increment;
  state.velocity += (2.0 / h) * solution.increment;
  state.acceleration = (2.0 / (h * h)) * solution.increment;  // (V₁−V₀)/h
  equations_.store_forces(problem, stage, solution, h, increment, 1.0 / h, state);
}

void Kane::advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) {
  Stage& stage = balance(problem, state, stages);
  require_contact(problem, state, stage);
  advance_state(problem, stage, stages.solve(0), state, increment);
}

SchemeRegistration kane_scheme() {
  return {"kane", [](double step, const Parameters&) { return std::make_unique<Kane>(step); }};
}

}  // namespace ricochet
