#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/simulation/simulation.hpp"

/// @file Adaptive steps of a simulation.
namespace ricochet {

/// Level of the shortest trial step.
constexpr int shortest_trial_level = 4;

/// Returns kinetic and elastic energy, summed over ranks.
double Simulation::energy_of_motion() const {
  return problem_.ranks->sum(0.5 * problem_.mass.quadratic_form(state_.velocity) +
                             stored_energy(*problem_.internal_force, state_.displacement, state_.internal_strain));
}

double Simulation::take_controlled_step() {
  state_before_attempt_ = state_;
  while (true) {
    use_level(control_->level());
    try {
      take_step(control_->level() == control_->deepest());
    } catch (const Error& problem) {
      if (problem.kind() != ErrorKind::not_converged || !control_->shorten()) throw;
      continue;
    }
    const double energy = energy_of_motion();
    if (control_->accept(state_before_attempt_, state_, energy)) return energy;
    state_ = state_before_attempt_;
    if (control_->needs_trial_step()) take_trial_step();
  }
}

/// Takes the longest step that has a solution, up to a level, and undoes it; if none has one, the energy ahead is
/// unknown (0). The energy account is restored as a whole: changing the step length there and back would leave rounding
/// errors relative to the algorithmic energy of the longest step.
void Simulation::take_trial_step() {
  const EnergyAccount account = *account_;
  const int shortest = std::min(shortest_trial_level, control_->deepest());
  double energy = 0.0;
  int level = 0;
  for (bool is_solved = false; !is_solved && level <= shortest; level += is_solved ? 0 : 1) {
    use_level(level);
    const double created_before = account_->method_energy(state_);
    try {
      take_step(false);
      is_solved = true;
    } catch (const Error& problem) {
      if (problem.kind() != ErrorKind::not_converged) throw;
      state_ = state_before_attempt_;
      continue;
    }
    state_.time += scheme_.step();
    complete_tied();
    account_->enter_step(increment_, state_);
    const double created = problem_.ranks->sum(account_->method_energy(state_) - created_before);
    energy = energy_of_motion() - std::max(created, 0.0);
  }
  state_ = state_before_attempt_;
  use_level(control_->level());
  account_ = std::make_unique<EnergyAccount>(account);
  control_->set_energy_ahead(std::min(level, shortest), energy);
}

}  // namespace ricochet
