#include "ricochet/scheme/semi_explicit/supported_motion.hpp"

namespace ricochet {

void start_supports(const SemidiscreteProblem& problem, const Vector& mass, double step, State& state) {
  Vector& next = state.memory[supported_next];
  problem.supports.values(step, next);
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const Index dof = problem.supports.dofs()[std::size_t(i)];
    if (problem.is_massless[std::size_t(dof)] != 0) continue;
    const double half = (next[i] - state.displacement[dof]) / step;
    const double acceleration = 2.0 * (half - state.velocity[dof]) / step;
    state.forces.support_reaction[i] += mass[dof] * (acceleration - state.acceleration[dof]);
    state.acceleration[dof] = acceleration;
  }
}

void SupportedMotion::advance(const SemidiscreteProblem& problem, const Vector& mass, const Vector& damping,
                              const Vector& force, const Vector& load, const Vector& increment, double step,
                              State& state) {
  if (problem.supports.size() == 0) return;
  Vector& next = state.memory.at(supported_next, problem.supports.size());
  problem.supports.values(state.time + 2.0 * step, next);
  if (contact_force_.size() == 0) contact_force_.setZero(problem.dof_count());
  for (const Index dof : contact_node_dofs_) contact_force_[dof] = 0.0;
  state.forces.rows->add_force(state.forces.normal_reaction, state.forces.tangential_reaction, contact_force_);
  state.forces.support_reaction.resize(problem.supports.size());
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const Index dof = problem.supports.dofs()[std::size_t(i)];
    const double before = increment[dof] / step;
    const double after = (next[i] - state.displacement[dof]) / step;
    const bool massless = problem.is_massless[std::size_t(dof)] != 0;
    state.acceleration[dof] = massless ? 0.0 : (after - before) / step;
    state.velocity[dof] = 0.5 * (before + after);
    state.forces.support_reaction[i] =
        mass[dof] * state.acceleration[dof] + force[dof] - load[dof] - contact_force_[dof];
    if (damping.size() > 0) state.forces.support_reaction[i] += damping[dof] * state.velocity[dof];
  }
}

}  // namespace ricochet
