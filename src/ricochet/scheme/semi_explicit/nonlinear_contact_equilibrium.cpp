#include "ricochet/scheme/semi_explicit/nonlinear_contact_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Key of State::memory; its first number is the step from which on the factor may be renewed.
constexpr const char* contact_renewal = "layer_renewal";
/// Iterations that count as many, and steps for which a new factor is kept: it costs as much as some tens of
/// evaluations of the internal force.
constexpr int renewal_iterations = 8;
constexpr double steps_between_renewals = 100.0;

double largest_on_contact(const SemidiscreteProblem& problem, const Vector& values) {
  double largest = 0.0;
  for (const Index dof : problem.contact_dofs) {
    if (!std::isfinite(values[dof])) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(values[dof]));
  }
  return largest;
}

}  // namespace

void NonlinearContactEquilibrium::analyse(const SemidiscreteProblem& problem) {
  contact_cells_ = problem.internal_force_at_contact();
  reach_ = problem.nodes.cwiseAbs().maxCoeff();
}

void NonlinearContactEquilibrium::start(State& state) const {
  if (contact_cells_) state.memory[contact_renewal].setZero(State::memory_numbers);
}

void NonlinearContactEquilibrium::renew_where_slow(const SemidiscreteProblem& problem, State& state,
                                                   StageSolve& stages) {
  if (!problem.has_contact_dofs() || newton_.progress().iterations() <= renewal_iterations) return;
  double& from = state.memory.at(contact_renewal, State::memory_numbers)[0];
  if (double(state.step) < from) return;
  from = double(state.step) + steps_between_renewals;
  stages.renew_operators(state.displacement, state.displacement);
}

void NonlinearContactEquilibrium::move_to_point() {
  const auto& [problem, state, load, step, stages, increment, end] = *task_;
  problem.scatter_contact(point_, increment);
  for (const Index dof : problem.contact_dofs) end[dof] = state.displacement[dof] + increment[dof];
}

/// Evaluates f at the end.
void NonlinearContactEquilibrium::evaluate() {
  move_to_point();
  contact_cells_->evaluate(task_->end, force_);
}

void NonlinearContactEquilibrium::require(Stage& stage) {
  const auto& [problem, state, load, step, stages, increment, end] = *task_;
  for (const Index dof : problem.contact_dofs) stage.right_hand_side.force[dof] = load[dof] - force_[dof];
  require_no_penetration(problem, end, state.time + step, stage);
  if (problem.has_moving_obstacles()) {
    middle_ = state.displacement + 0.5 * increment;
    evaluate_obstacle_velocity(problem, middle_, {state.time + 0.5 * step, step, 0.5}, stage);
  }
  if (problem.contact.has_friction()) {
    rate_ = increment / step;
    require_friction(problem, rate_, 1.0 / step, stage);
  }
  if (problem.contact.follows_motion()) stage.motion.reset();  // an iteration has the rows of its start
}

NewtonEquations::Iteration NonlinearContactEquilibrium::iterate() {
  Stage& stage = task_->stages.stage(0);
  require(stage);
  solution_ = &task_->stages.solve(0);
  const double correction = largest_on_contact(task_->problem, solution_->increment);
  if (correction > last_correction_) acceleration_.restart();
  last_correction_ = correction;
  last_point_ = point_;
  if (std::isfinite(correction)) {
    task_->problem.gather_contact(solution_->increment, point_);
    point_ += last_point_;
  }
  return {correction, point_.lpNorm<Eigen::Infinity>()};
}

const StageSolution* NonlinearContactEquilibrium::solve(const SemidiscreteProblem& problem, const State& state,
                                                        const Vector& load, double step, StageSolve& stages,
                                                        Vector& increment, Vector& end) {
  if (!problem.has_contact_dofs()) return nullptr;
  const Task task{problem, state, load, step, stages, increment, end};
  task_ = &task;
  stages.rotate_operators(end);
  Stage& stage = stages.stage(0);
  if (stage.right_hand_side.force.size() != problem.dof_count())
    stage.right_hand_side.force.setZero(problem.dof_count());
  stage.right_hand_side.prescribed.setZero(
      problem.supports.size());  // supported nodes are at their prescribed displacements
  point_.resize(Index(problem.contact_dofs.size()));
  problem.gather_contact(increment, point_);
  last_correction_ = std::numeric_limits<double>::infinity();
  evaluate();
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * (reach_ + largest_on_contact(problem, end));
  try {
    newton_.solve(*this, {rounding, stages.renewal_price()}, Persistence::full);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_converged) throw;
    throw Error(error.kind(), fmt::format("no equilibrium of the contact nodes was found: {}", error.what()));
  }
  move_to_point();
  return solution_;
}

}  // namespace ricochet
