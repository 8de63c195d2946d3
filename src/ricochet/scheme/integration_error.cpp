#include "ricochet/scheme/integration_error.hpp"

namespace ricochet {

void IntegrationError::begin(const SemidiscreteProblem& problem, const State& state) {
  if (problem.internal_force->is_linear() || step_ == state.step) return;
  step_ = -1;  // substeps have the same step number at other displacements
  problem.internal_force->evaluate(state.displacement, force_);
  energy_ = problem.internal_force->energy(state.displacement);
}

double IntegrationError::end(const SemidiscreteProblem& problem, const Vector& increment, double weight,
                             const State& state) {
  mean_ = (1.0 - weight) * force_;
  step_ = -1;
  problem.internal_force->evaluate(state.displacement, force_);
  mean_ += weight * force_;
  const double before = energy_;
  energy_ = problem.internal_force->energy(state.displacement);
  step_ = state.step + 1;
  return (energy_ - before) - increment.dot(mean_);
}

double MidpointIntegrationError::of_step(const SemidiscreteProblem& problem, const State& state,
                                         const Vector& increment) {
  if (problem.internal_force->is_linear()) return 0.0;
  const double before = step_ == state.step ? energy_ : problem.internal_force->energy(state.displacement);
  step_ = -1;
  displacement_ = state.displacement + 0.5 * increment;
  problem.internal_force->evaluate(displacement_, force_);
  displacement_ = state.displacement + increment;
  energy_ = problem.internal_force->energy(displacement_);
  step_ = state.step + 1;
  return (energy_ - before) - increment.dot(force_);
}

}  // namespace ricochet
