#include "ricochet/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/fem/distortion_law.hpp"
#include "ricochet/problem/distortion_force.hpp"
#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/scheme/requirements.hpp"

namespace ricochet {

namespace {

/// Checks the dofs that the stage solves for; a stage of contact nodes need not inspect the whole body.
bool is_finite(const SemidiscreteProblem& problem, StageDofs dofs, const Vector& increment) {
  if (dofs != StageDofs::contact) return increment.allFinite();
  return std::ranges::all_of(problem.contact_dofs, [&](Index dof) { return std::isfinite(increment[dof]); });
}

constexpr const char* nameless = "this time scheme";

}  // namespace

Simulation::Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const StepSolverOptions& options,
                       const std::optional<StepControlOptions>& control)
    : problem_(problem),
      contact_points_(problem.global_contact_point_count()),
      scheme_(scheme),
      options_(options),
      whole_step_(scheme.step()),
      part_lengths_(!problem.internal_force->is_linear()) {
  if (!control) return;
  require_changing_steps(scheme_, nameless);
  control_.emplace(problem_, *control);
}

Simulation::Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const InitialConditions& initial,
                       const StepSolverOptions& options, const std::optional<StepControlOptions>& control)
    : Simulation(problem, scheme, options, control) {
  if (!scheme_.traits().supports_nonlinear_force) require_linear(*problem_.internal_force, nameless);
  require_relaxation(scheme_, problem_, nameless);
  scheme_.analyse(problem_);
  state_ = make_starting_state(problem_, initial, scheme_.step(), options);
  control_distortion();
  require_upright_start();
  if (control_) {
    control_->start(state_);
    scheme_.change_step(problem_, control_->step());
  }
  current_ = &make_level(control_ ? control_->level() : 0, options_);
  scheme_.start(problem_, state_, *this);
  complete_tied();
  account_ = std::make_unique<EnergyAccount>(problem_, scheme_, state_);
  set_up_tunnelling_watches();
}

Simulation::Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const Snapshot& snapshot,
                       const StepSolverOptions& options, const std::optional<StepControlOptions>& control)
    : Simulation(problem, scheme, options, control) {
  const SnapshotVisitor visit = snapshot.loader("");
  persist(visit);
  account_ = std::make_unique<EnergyAccount>(problem_, scheme_, state_, visit.part("account"));
  set_up_tunnelling_watches();
}

void Simulation::require_upright_start() const {
  if (std::isfinite(problem_.internal_force->energy(state_.displacement))) return;
  try {
    Vector force;
    problem_.internal_force->evaluate(state_.displacement, force);
  } catch (const Error& error) {
    throw Error(ErrorKind::invalid_input, fmt::format("initial.displacement: {}", error.what()));
  }
}

void Simulation::save(Snapshot& snapshot) {
  const SnapshotVisitor visit = snapshot.saver("");
  persist(visit);
  account_->persist(visit.part("account"));
}

void Simulation::persist(const SnapshotVisitor& visit) {
  const SnapshotVisitor bodies = visit.part("free_body");
  for (std::size_t k = 0; k < problem_.free_bodies.size(); ++k) problem_.free_bodies[k]->persist(bodies.part(k));
  ricochet::persist(visit.part("state"), problem_, state_);
  if (visit.loads()) {
    control_distortion();
    scheme_.analyse(problem_);
  }
  if (control_) control_->persist(visit.part("control"));
  visit("cut_steps", cut_steps_);
  visit("told_short_parts", short_parts_warned_);
  part_lengths_.persist(visit.part("part_lengths"));
  persist_levels(visit);
}

void Simulation::persist_levels(const SnapshotVisitor& visit) {
  std::vector<int> numbers, failed;
  int current = 0;
  for (const auto& [number, level] : levels_) {
    numbers.push_back(number);
    failed.push_back(level.has_failed ? 1 : 0);
    if (&level == current_) current = number;
  }
  visit("levels", numbers, {0, control_ ? control_->deepest() : PartLengths::deepest});
  visit("level", current);
  visit("failed_levels", failed, {0, 1}, Index(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const int number = numbers[i];
    const SnapshotVisitor saved = visit.part("solver").part(std::size_t(number));
    if (visit.loads()) {
      if (scheme_.step() != length_of(number)) scheme_.change_step(problem_, length_of(number));
      // The saved methods are kept even if others would now be chosen for the remaining steps: they change the bits.
      StepSolverOptions stored = options_;
      stored.chosen = saved_methods(saved, scheme_.operators(problem_));
      make_level(number, stored);
    }
    levels_.at(number).solver->persist(saved);
    levels_.at(number).has_failed = failed[i] == 1;
  }
  if (!visit.loads()) return;
  visit.require(levels_.contains(current), "level", "is none of the saved step lengths");
  if (scheme_.step() != length_of(current)) scheme_.change_step(problem_, length_of(current));
  current_ = &levels_.at(current);
}

Simulation::Level& Simulation::make_level(int number, const StepSolverOptions& options) {
  const std::vector<OperatorCoefficients> operators = scheme_.operators(problem_);
  Level& level = levels_[number];
  level.solver = make_step_solver(problem_, operators, options);
  level.solver->observe_contact(observer_);
  level.stages.resize(operators.size());
  for (std::size_t i = 0; i < operators.size(); ++i) {
    level.stages[i].dofs = operators[i].dofs;
    level.stages[i].stage.rows = problem_.contact.rows;
  }
  return level;
}

void Simulation::observe_contact(const ContactObserver& observer) {
  observer_ = observer;
  for (auto& [number, level] : levels_) level.solver->observe_contact(observer);
}

std::size_t Simulation::factor_entries() const {
  std::size_t sum = 0;
  for (const auto& [number, level] : levels_) sum += level.solver->factor_entries();
  return sum;
}

IterationCounts Simulation::iteration_counts() const {
  IterationCounts sum;
  for (const auto& [number, level] : levels_) sum += level.solver->iteration_counts();
  return sum;
}

double Simulation::contact_seconds() const {
  double sum = 0.0;
  for (const auto& [number, level] : levels_) sum += level.solver->contact_seconds();
  return sum;
}

Stage& Simulation::stage(std::size_t number) { return current_->stages.at(number).stage; }

const StageSolution& Simulation::solve(std::size_t number) {
  auto& [stage, solution, dofs] = current_->stages.at(number);
  current_->solver->solve(number, stage, solution);
  if (problem_.ranks->any(!is_finite(problem_, dofs, solution.increment))) {
    throw Error(ErrorKind::not_converged, problem_.internal_force->is_linear()
                                              ? "the displacement is no longer finite, so the motion has diverged; use "
                                                "a stable scheme (reduced-kane with mass \"equivalent\")"
                                              : "a correction of Newton's method has entries that are not finite");
  }
  iterations_ += solution.iterations;
  // Stages of contact nodes alone, if there are other stages, are solved within the iterations of these.
  const bool counts = dofs != StageDofs::contact || current_->stages.size() == 1;
  if (!problem_.internal_force->is_linear() && counts) newton_iterations_ += solution.newton_iterations;
  return solution;
}

void Simulation::solve_exactly(std::size_t number, ExactTangent& tangent, StageSolution& solution, Vector& unknowns) {
  const int before = solution.iterations;
  exact_stage_.solve(tangent, current_->stages.at(number).stage.conditions.eligible, solution, unknowns);
  iterations_ += solution.iterations - before;
  ++newton_iterations_;
}

/// Sets up the check of contact nodes, and of contact points that lie between nodes, against the obstacles that they
/// touch, if these have another side.
void Simulation::set_up_tunnelling_watches() {
  const ContactBoundary& contact = problem_.contact;
  std::map<const Obstacle*, std::vector<Index>> nodes, points;
  for (Index point = 0; point < contact.size(); ++point) {
    const Obstacle* const obstacle = problem_.obstacle_of_point(point);
    if (obstacle == nullptr || obstacle->shape().is_flat()) continue;
    int node_count = 0;
    contact.visit_own_nodes(point, [&node_count](Index, double) { ++node_count; });
    if (node_count > 1) points[obstacle].push_back(point);
  }
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    const Obstacle* const obstacle = problem_.obstacles[std::size_t(contact.node_pair[i])];
    if (obstacle != nullptr && !obstacle->shape().is_flat()) nodes[obstacle].push_back(contact.nodes[i]);
  }
  // The order is that of the case, as the order of addresses in memory is arbitrary.
  for (const Obstacle* const obstacle : problem_.obstacles) {
    const auto found = nodes.find(obstacle);
    if (found == nodes.end()) continue;
    guards_.emplace_back(problem_, std::move(found->second), std::vector{obstacle});
    nodes.erase(found);
    if (std::vector<Index>& others = points[obstacle]; !others.empty())
      guards_.emplace_back(problem_, std::move(others), std::vector{obstacle}, TunnellingWatch::Of::contact_points);
  }
  for (TunnellingWatch& guard : guards_) guard.check(state_);
  has_guards_ = problem_.ranks->any(!guards_.empty());
}

/// Whether some volume ratio at the nodes of cells is below a limit.
bool Simulation::is_distorted(double limit) const {
  const CellVolume smallest = problem_.internal_force->distortion()->smallest_nodal_volume(state_.displacement);
  return problem_.ranks->any(smallest.volume_ratio < limit);
}

/// Includes the control of distorted cells in the step if some are distorted at its start. Returns whether it may be
/// missing at the end.
bool Simulation::control_distortion() const {
  const DistortionForce* const distortion = problem_.internal_force->distortion();
  if (distortion == nullptr) return false;
  const bool is_on = is_distorted(distortion_watch_ratio);
  distortion->control_distortion(is_on);
  return !is_on;
}

/// Refuses a step in which a node goes through an obstacle, if the step can be shorter.
void Simulation::take_step(bool is_shortest) {
  is_shortest_ = is_shortest;
  has_tunnelled_ = false;
  const bool is_guarded = has_guards_ && !is_shortest, may_distort = control_distortion();
  if (is_guarded || may_distort) unguarded_ = state_;
  solve_step();
  if (may_distort && is_distorted(distortion_volume_ratio)) {
    state_ = unguarded_;
    problem_.internal_force->distortion()->control_distortion(true);
    solve_step();
  }
  const double end = state_.time + scheme_.step();
  const auto passes = [&](const TunnellingWatch& guard) { return guard.any_tunnels(state_, end); };
  if (!is_guarded || !problem_.ranks->any(std::ranges::any_of(guards_, passes))) return;
  state_ = unguarded_;
  has_tunnelled_ = true;
  throw Error(ErrorKind::not_converged,
              fmt::format("step {} (t = {:.9g}, step size {:.3g}): a node goes through an obstacle within the step",
                          state_.step + 1, end, scheme_.step()));
}

/// Leaves step and time unchanged. If no solution is found, the operators may belong to a configuration too far away:
/// the step is attempted again with those of the tangent at its start. Where steps of this length have just had no
/// solution with these either, their operators are older still, and the only attempt begins with the tangent.
void Simulation::solve_step() {
  Level& level = *current_;
  if (!level.has_failed) {
    try {
      attempt_step();
      return;
    } catch (const Error& problem) {
      if (problem.kind() != ErrorKind::not_converged || problem_.internal_force->is_linear()) throw;
      log::debug(fmt::format("{}: attempting the step again, with the tangent at its start", problem.what()));
    }
  }
  level.has_failed = true;
  renew_operators(state_.displacement, state_.displacement);
  attempt_step();
  level.has_failed = false;
}

/// Attempts the step once.
void Simulation::attempt_step() {
  iterations_ = 0;
  for (const auto& body : problem_.free_bodies) body->begin_step(state_.displacement);
  // Rows that follow the motion continue from those of the state, whatever has been solved in between.
  if (problem_.contact.follows_motion()) {
    problem_.contact.geometry->begin_step();
    for (SolvedStage& each : current_->stages) each.stage.rows = state_.forces.rows;
  }
  try {
    scheme_.advance(problem_, state_, *this, increment_);
  } catch (const Error& problem) {
    throw Error(problem.kind(),
                fmt::format("step {} (t = {:.9g}, step size {:.3g}, {} contact points): {}", state_.step + 1,
                            state_.time + scheme_.step(), scheme_.step(), contact_points_, problem.what()));
  }
  if (problem_.contact.follows_motion()) problem_.contact.geometry->end_step();
  state_.iterations = iterations_;
  state_.newton_iterations = newton_iterations_;
}

/// Factorizes operators that are needed for the first time.
void Simulation::use_level(int number) {
  if (scheme_.step() != length_of(number))
    account_->change_step(state_, [&] { scheme_.change_step(problem_, length_of(number)); });
  if (const auto found = levels_.find(number); found != levels_.end()) {
    current_ = &found->second;
    return;
  }
  // Where those of another length have failed, operators of the undeformed body would fail, too.
  const bool has_failed = current_->has_failed;
  current_ = &make_level(number, options_);
  current_->has_failed = has_failed;
}

/// The impulse is not used by the equations; it serves those who monitor the state.
Vector Simulation::set_velocity(const Vector& velocity) {
  Vector change = velocity - state_.velocity, impulse;
  for (const Index dof : problem_.supports.dofs()) change[dof] = 0.0;
  if (problem_.tied != nullptr) problem_.tied->complete(change, problem_.dimension);
  account_->enter_impulse(state_, [&] { scheme_.change_velocity(state_, change); });
  problem_.mass.multiply(change, impulse);
  return impulse;
}

void Simulation::complete_tied() {
  if (problem_.tied == nullptr) return;
  for (Vector* const values : {&state_.displacement, &state_.velocity, &state_.acceleration})
    problem_.tied->complete(*values, problem_.dimension);
}

double Simulation::length_of(int level) const {
  return control_ ? control_->step_of(level) : std::ldexp(whole_step_, -level);
}

void Simulation::end_part(const std::function<void(const State&)>& each_part) {
  complete_tied();
  account_->enter_step(increment_, state_);
  for (TunnellingWatch& guard : guards_) guard.check(state_);
  if (each_part) each_part(state_);
}

void Simulation::advance(const std::function<void(const State&)>& each_part) {
  double energy = 0.0;
  bool is_whole = true;
  newton_iterations_ = 0;
  if (control_) {
    energy = take_controlled_step();
  } else {
    is_whole = take_fixed_step(each_part);
  }
  state_.step += 1;
  state_.time = control_ ? control_->time() : double(state_.step) * whole_step_;
  if (is_whole) end_part(each_part);
  if (control_) control_->watch(energy, problem_.ranks->sum(account_->method_energy(state_)));
}

}  // namespace ricochet
