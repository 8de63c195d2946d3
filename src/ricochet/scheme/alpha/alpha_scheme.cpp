#include "ricochet/scheme/alpha/alpha_scheme.hpp"

#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

AlphaWeights::AlphaWeights(double step, double of_inertia, double of_forces)
    : inertia_weight(of_inertia),
      force_weight(of_forces),
      gamma(0.5 + of_forces - of_inertia),
      beta(0.25 * (0.5 + gamma) * (0.5 + gamma)),
      alpha((1.0 - of_inertia) / ((1.0 - of_forces) * beta * step * step)),
      energy_factor(0.5 * step * step * (beta - 0.5 * gamma)) {}

AlphaWeights generalized_alpha_weights(double step, double spectral_radius) {
  return {step, (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0), spectral_radius / (spectral_radius + 1.0)};
}

void AlphaScheme::start(const SemidiscreteProblem&, State& state, StageSolve&) {
  state.memory[algorithmic_acceleration] = state.acceleration;
}

void AlphaScheme::advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) {
  const double h = step(), end = state.time + h;
  Vector& before = state.dof_memory(algorithmic_acceleration);
  error_.begin(problem, state);
  shift_ = (weights_.inertia_weight * before - weights_.force_weight * state.acceleration) /
           ((1.0 - weights_.force_weight) * weights_.alpha);  // c/α
  predicted_ = h * state.velocity + (h * h * (0.5 - weights_.beta)) * before - shift_;
  base_ = state.displacement + predicted_;
  Stage& stage = stages.stage(0);
  if (problem.has_damping()) compute_damping_velocity(problem, state, before);
  equations_.balance(problem, end, base_, velocity_, stage);
  equations_.prescribe_from(problem, end, base_, stage);
  require_no_penetration(problem, base_, end, stage);
  equations_.require_friction_over_step(problem, state, predicted_, h, stage);

  const StageSolution& solution = stages.solve(0);
  increment = predicted_ + solution.increment;
  change_ = (solution.increment - shift_) / (weights_.beta * h * h);  // A₁
  for (const Index dof : problem.massless_dofs) change_[dof] = 0.0;
  state.displacement += increment;
  integration_error_ =
      problem.internal_force->is_linear() ? 0.0 : error_.end(problem, increment, 1.0 - weights_.force_weight, state);
  state.velocity += h * ((1.0 - weights_.gamma) * before + weights_.gamma * change_);
  change_ -= before;
  before += change_;
  compute_dissipation(problem, increment);
  state.acceleration = weights_.alpha * solution.increment;
  follow_without_inertia(problem, increment, h, state);
  if (problem.has_damping()) velocity_ += damping_factor(problem) * solution.increment;
  equations_.store_forces(problem, stage, solution, h, velocity_, 1.0, state);
}

/// Computes the velocity that damping acts on, at δ = 0.
void AlphaScheme::compute_damping_velocity(const SemidiscreteProblem& problem, const State& state,
                                           const Vector& before) {
  if (problem.has_singular_mass()) {
    velocity_ = predicted_ / step();
  } else {
    velocity_ = state.velocity + (step() * (1.0 - weights_.gamma)) * before -
                (weights_.gamma / (weights_.beta * step())) * shift_;
  }
}

void AlphaScheme::compute_dissipation(const SemidiscreteProblem& problem, const Vector& increment) {
  problem.mass.multiply(change_, force_);
  dissipation_ = weights_.energy_factor * (2.0 * weights_.gamma - 1.0) * change_.dot(force_);
  if (weights_.force_weight == 0.5) return;
  dissipation_ += (0.5 - weights_.force_weight) * increment.dot(force_);
  if (!problem.internal_force->is_linear()) return;
  dissipation_ += (0.5 - weights_.force_weight) * elastic_product(problem, increment, increment, force_);
}

double AlphaScheme::algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const {
  return weights_.energy_factor == 0.0
             ? 0.0
             : weights_.energy_factor * problem.mass.quadratic_form(state.dof_memory(algorithmic_acceleration));
}

bool AlphaScheme::momentum_acceleration(const State& state, Vector& acceleration) const {
  if (weights_.force_weight == 0.5) return false;
  acceleration = (0.5 - weights_.force_weight) * state.dof_memory(algorithmic_acceleration);
  return true;
}

Key spectral_radius_key(double least) {
  return number_key(
      "spectral_radius", "1", {.default_value = "0.8", .range = {.at_least = least, .at_most = 1.0}},
      "Fraction that one step leaves of vibrations much faster than the step: 1 damps none; at least 1/2 for "
      "hht-alpha, 0 for the others.");
}

}  // namespace ricochet
