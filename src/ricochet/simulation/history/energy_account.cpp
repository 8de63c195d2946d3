#include "ricochet/simulation/history/energy_account.hpp"

#include <algorithm>
#include <cmath>

#include "ricochet/problem/viscous_force.hpp"

namespace ricochet {

EnergyAccount::EnergyAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state)
    : problem_(problem), scheme_(scheme), rule_(scheme.traits().work_rule), previous_(state.forces) {
  const Energies start = energies(state);
  initial_ = start.total() + start.algorithmic;
  initial_algorithmic_ = start.algorithmic;
  if (problem.contact.has_sliding_pairs()) problem.gaps(state.displacement, state.time, gap_before_);
}

EnergyAccount::EnergyAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state,
                             const SnapshotVisitor& saved)
    : problem_(problem), scheme_(scheme), rule_(scheme.traits().work_rule), previous_(state.forces) {
  persist(saved);
}

void EnergyAccount::persist(const SnapshotVisitor& visit) {
  visit.numbers("works", works_.load, works_.contact, works_.friction, works_.support, works_.obstacle, works_.damping,
                works_.numerical_dissipation, works_.integration_error, works_.viscous_dissipation, works_.re_pairing,
                works_.velocity_correction);
  visit("initial", initial_);
  visit("initial_algorithmic", initial_algorithmic_);
  if (problem_.contact.has_sliding_pairs()) visit("gap_before", gap_before_, problem_.contact.size());
}

EnergyAccount::StepWorks EnergyAccount::works_of(const StepForces& forces, const Vector& increment,
                                                 const ObstacleMotion& obstacle) {
  StepWorks result;
  const Vector &normal = forces.acting_normal(), &tangential = forces.acting_tangential();
  result.contact = normal.dot(gap_increment_);
  if (tangential.size() > 0) result.friction = -tangential.dot(slip_increment_);
  if (obstacle.normal.size() > 0) {
    result.obstacle = normal.dot(obstacle.normal);
    if (tangential.size() > 0) result.obstacle -= tangential.dot(obstacle.tangential);
  }
  if (forces.support_reaction.size() > 0) result.support = problem_.supports.work(forces.support_reaction, increment);
  if (forces.varying_load.size() > 0) result.load = forces.varying_load.dot(increment);
  if (forces.damping_force.size() > 0) result.damping = -forces.damping_force.dot(increment);
  return result;
}

void EnergyAccount::find_motion(const ContactRows& rows, const Vector& increment, ObstacleMotion& obstacle) {
  project_motion(rows, obstacle);
  motion_from_obstacles(rows, increment, obstacle, gap_increment_);
  if (problem_.contact.has_friction()) slip_on_obstacles(rows, increment, obstacle, slip_increment_);
}

void EnergyAccount::evaluate_gaps(const State& state) {
  problem_.gaps(state.displacement, state.time, gap_now_);
  unsettled_gap_ = 0.0;
  for (Index i = 0; i < gap_now_.size(); ++i) {
    if (problem_.contact.slides(i) && state.forces.normal_reaction[i] > 0.0 &&
        gap_now_[i] < problem_.contact.unpaired_gap)
      unsettled_gap_ = std::max(unsettled_gap_, std::abs(gap_now_[i]));
  }
}

/// Uses the rows along which the motion has last been computed.
void EnergyAccount::enter_re_pairing(const StepForces& forces, double weight) {
  const Vector& normal = forces.acting_normal();
  for (Index i = 0; i < normal.size(); ++i) {
    if (normal[i] == 0.0 || !problem_.contact.slides(i)) continue;
    // The change between facing nothing and facing a surface is no change of a gap.
    if (std::max(gap_now_[i], gap_before_[i]) >= problem_.contact.unpaired_gap) continue;
    works_.re_pairing += weight * normal[i] * (gap_increment_[i] - (gap_now_[i] - gap_before_[i]));
  }
}

/// `rows`: those along which the motion was computed before.
void EnergyAccount::enter(const StepForces& forces, double weight, const Vector& increment, const ContactRows*& rows) {
  if (weight == 0.0) return;
  if (rows != forces.rows.get()) find_motion(*forces.rows, increment, obstacle_);
  rows = forces.rows.get();
  const StepWorks step = works_of(forces, increment, obstacle_);
  if (gap_now_.size() > 0) enter_re_pairing(forces, weight);
  works_.contact += weight * step.contact;
  works_.friction += weight * step.friction;
  works_.obstacle += weight * step.obstacle;
  works_.support += weight * step.support;
  works_.load += weight * step.load;
  works_.damping += weight * step.damping;
}

void EnergyAccount::enter_step(const Vector& increment, const State& state) {
  obstacle_ = state.obstacle_increment;
  if (problem_.contact.has_sliding_pairs()) evaluate_gaps(state);
  // Forces work along the rows through which they act: those of the two ends of a step differ if they follow the
  // motion, and the motion along the rows of one end would violate the energy balance of the other's forces.
  const ContactRows* rows = nullptr;
  enter(previous_, rule_.previous_weight, increment, rows);
  enter(state.forces, rule_.current_weight, increment, rows);
  const LastStep last = scheme_.last_step();
  for (const OtherStageForces& part : last.other_stages) {
    obstacle_ = part.obstacle_increment;
    rows = nullptr;
    enter(part.forces, part.weight, part.increment, rows);
  }
  const StepCorrections& corrections = last.corrections;
  works_.contact += corrections.contact_work;
  works_.friction += corrections.friction_work;
  works_.support += corrections.support_work;
  works_.load += corrections.load_work;
  works_.numerical_dissipation += corrections.numerical_dissipation;
  works_.integration_error += corrections.integration_error;
  works_.viscous_dissipation += corrections.viscous_dissipation;
  works_.velocity_correction += corrections.velocity_correction;
  previous_ = state.forces;
  std::swap(gap_before_, gap_now_);
  algorithmic_.reset();
}

void EnergyAccount::change_step(const State& state, const std::function<void()>& change) {
  const double before = algorithmic(state);
  change();
  algorithmic_.reset();
  works_.numerical_dissipation -= algorithmic(state) - before;
}

void EnergyAccount::enter_impulse(const State& state, const std::function<void()>& change) {
  const auto energy = [&] {
    algorithmic_.reset();
    const Energies now = energies(state);
    return now.total() + now.algorithmic;
  };
  const double before = energy();
  change();
  works_.load += energy() - before;
}

/// The value is kept since rows of the history and the checks of the method both request it.
double EnergyAccount::algorithmic(const State& state) {
  if (!algorithmic_) algorithmic_ = scheme_.algorithmic_energy(problem_, state);
  return *algorithmic_;
}

double EnergyAccount::method_energy(const State& state) {
  return works_.contact + works_.integration_error - works_.numerical_dissipation -
         (algorithmic(state) - initial_algorithmic_);
}

Energies EnergyAccount::energies(const State& state) {
  const bool at_state = scheme_.traits().energy_instant == 0.0;
  if (!at_state) scheme_.energy_state(state, displacement_, velocity_);
  const Vector& displacement = at_state ? state.displacement : displacement_;
  const Vector* const force = scheme_.internal_force(state);
  Energies result;
  result.kinetic = 0.5 * problem_.mass.quadratic_form(velocity(state));
  result.elastic = force != nullptr ? problem_.internal_force->energy(displacement, *force)
                                    : stored_energy(*problem_.internal_force, displacement, state.internal_strain);
  result.load_potential = -problem_.loads.constant().dot(displacement);
  result.algorithmic = algorithmic(state);
  return result;
}

double EnergyAccount::residual(const Energies& now) const {
  return now.total() + now.algorithmic - initial_ - works_.sum() + works_.numerical_dissipation +
         works_.viscous_dissipation - works_.integration_error;
}

}  // namespace ricochet
