#include "ricochet/scheme/reduced/finite_strain_iterate.hpp"

#include <algorithm>
#include <limits>

#include "ricochet/scheme/reduced/massless_contact_step.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Overlap of a pressed point that needs no further iteration, relative to the size of the model: a part of the
/// tolerance of Newton's method, and far above the rounding errors of positions.
double relative_penetration(double newton_tolerance) { return std::max(1e-10, 1e-4 * newton_tolerance); }

/// Work of a force on contact nodes and on rigid bodies that move freely.
double on_contact(const SemidiscreteProblem& problem, const Vector& force, const Vector& increment) {
  double sum = 0.0;
  for (const Index dof : problem.contact_dofs) sum += force[dof] * increment[dof];
  for (Index dof = problem.cell_node_count() * problem.dimension; dof < increment.size(); ++dof)
    sum += force[dof] * increment[dof];
  return sum;
}

/// Work of reactions on the motion of the obstacles over a step.
double obstacle_work(Stage& stage, const Vector& normal, const Vector& tangential, double step) {
  if (stage.obstacle.normal.size() == 0) return 0.0;
  project_motion(*stage.rows, stage.obstacle);
  return step * (normal.dot(stage.obstacle.normal) -
                 (tangential.size() > 0 ? tangential.dot(stage.obstacle.tangential) : 0.0));
}

}  // namespace

Stage& StepTask::middle_stage() const { return stages.stage(MasslessContactStep::midpoint_stage(problem)); }

void FiniteStrainIterate::analyse(const SemidiscreteProblem& problem, double step) {
  whole_step_ = step;
  flight_ = std::make_unique<FlightPrediction>(problem);
  balance_.analyse(problem, flight_->bodies());
  couples_ = std::make_unique<ContactCouples>(problem);
  contact_cells_ = problem.internal_force_at_contact();
  lowest_rules_ = problem.internal_force->path_rules();
  extent_ = extent(problem.nodes);
}

void FiniteStrainIterate::start(const StepTask& task) {
  task_ = &task;
  const State& state = task.state;
  loads_.start(task.problem, task.step, state);
  base_ = state.displacement + (0.5 * task.step) * state.velocity;
  flight_->predict(state.displacement, state.velocity, task.step, now_.end);
  now_.middle = 0.5 * (state.displacement + now_.end);
  path_rules_ = lowest_rules_;
  path_increment_ = 2.0 * (now_.end - now_.middle);
  task.problem.internal_force->raise_path_rules(now_.middle, path_increment_, path_rules_);
  raises_ = 0;
  end_contact_force_.setZero(task.problem.dof_count());
  mean_contact_force_.setZero(task.problem.dof_count());
  balance_.start(task.problem, state, task.step / whole_step_);
  last_.middle = last_.end = state.displacement;
}

void FiniteStrainIterate::start_at_rest(const StepTask& task) {
  start(task);
  now_.middle = now_.end = task.state.displacement;
}

/// The norm of a node's motion does not depend on the axes, so that rotated motions get the same advice.
double FiniteStrainIterate::largest_motion(const Vector& motion) const {
  const SemidiscreteProblem& problem = task_->problem;
  return motion.reshaped(problem.dimension, problem.nodes.cols()).colwise().norm().maxCoeff();
}

NewtonEquations::Iteration FiniteStrainIterate::sizes() {
  NewtonEquations::Iteration result;
  motion_ = now_.end - last_.end;
  result.correction = largest_motion(motion_);
  motion_ = 2.0 * (now_.middle - last_.middle);
  result.correction = std::max(result.correction, largest_motion(motion_));
  motion_ = 2.0 * (now_.middle - base_);
  result.increment = largest_motion(motion_);
  return result;
}

double FiniteStrainIterate::rounding_of_positions() const {
  const double size = task_->problem.nodes.cwiseAbs().maxCoeff() + now_.end.lpNorm<Eigen::Infinity>();
  return 8.0 * std::numeric_limits<double>::epsilon() * size;
}

void FiniteStrainIterate::halve() {
  now_.middle = 0.5 * (now_.middle + last_.middle);
  now_.end = 0.5 * (now_.end + last_.end);
}

bool FiniteStrainIterate::raise_rules(bool is_solution) {
  const int raises = is_solution ? 2 : 1;
  if (raises_ >= raises) return false;
  raises_ = raises;
  path_increment_ = 2.0 * (now_.end - now_.middle);
  return task_->problem.internal_force->raise_path_rules(now_.middle, path_increment_, path_rules_);
}

void FiniteStrainIterate::evaluate() {
  const auto& [problem, acting, step, state, stages] = *task_;
  const InternalForce& elastic = *problem.internal_force;
  path_increment_ = 2.0 * (now_.end - now_.middle);
  elastic.path_force(now_.middle, path_increment_, path_rules_, force_);
  const BranchStep branches{now_.middle, path_increment_, state.displacement, now_.end, state.internal_strain, step};
  if (const ViscousForce* const viscous = elastic.viscous(); viscous != nullptr)
    viscous->add_mean_force(branches, force_);
  if (contact_cells_) contact_cells_->evaluate(now_.end, end_force_);
  if (contact_cells_ && contact_cells_->viscous() != nullptr)
    contact_cells_->viscous()->add_end_force(branches, end_force_);
  loads_.evaluate(problem, now_.middle, now_.end, contact_cells_ != nullptr);
}

/// Computes L̄ + P(x) − D − M (v₁−v₀)/h − (2/h) C (x−u₀): the force that is not balanced, without that of contact.
void FiniteStrainIterate::find_imbalance(Vector& force) {
  const auto& [problem, acting, step, state, stages] = *task_;
  inertial_increment_ = now_.middle - base_;
  problem.mass.multiply(inertial_increment_, inertial_force_);
  force = loads_.mean() - force_ - (4.0 / (step * step)) * inertial_force_;
  loads_.add_pressure(force);
  for (const auto& body : problem.free_bodies) body->add_gyroscopic_force(now_.end, state.velocity, step, force);
  if (!problem.has_damping()) return;
  half_increment_ = now_.middle - state.displacement;
  problem.damping.evaluate(half_increment_, damping_force_);
  force -= (2.0 / step) * damping_force_;
}

void FiniteStrainIterate::balance_middle(Stage& stage) {
  const State& state = task_->state;
  find_imbalance(stage.right_hand_side.force);
  const auto half_way = [&](Index dof, double end) { return 0.5 * (state.displacement[dof] + end) - now_.middle[dof]; };
  equations_.prescribe(task_->problem, state.time + task_->step, half_way, stage);
}

void FiniteStrainIterate::find_end_residual(Vector& residual) const {
  residual = loads_.mean() - end_force_;
  if (loads_.acts_at_ends()) residual += loads_.beside_at_end();
}

void FiniteStrainIterate::require_contact(const Vector& end, const Vector& linear_about, Stage& stage) {
  contact_.require(task_->problem, task_->acting, task_->step, task_->state, end, equations_, stage, &linear_about);
}

/// Computes the contact forces of the last iteration, their works, and the residual R of all forces at the middle.
void FiniteStrainIterate::find_residual(const StageSolution& solution, Stage& stage) {
  const auto& [problem, acting, step, state, stages] = *task_;
  const bool has_contact = problem.has_contact_dofs();
  if (has_contact) {
    if (problem.has_rotating_obstacles())
      equations_.observe_step(problem, state.displacement, state.time, now_.end, step, stage);
    motion_ = now_.end - state.displacement;
    const auto work_of = [&](const Vector& normal, const Vector& tangential, Vector& force) {
      force.setZero(motion_.size());
      stage.rows->add_force(normal, tangential, force);
      return on_contact(task_->problem, force, motion_) - obstacle_work(stage, normal, tangential, task_->step);
    };
    work_of_mean_ = work_of(solution.acting_normal(), solution.acting_tangential(), mean_contact_force_);
    work_at_end_ = work_of(solution.normal_reaction, solution.tangential_reaction, end_contact_force_);
  }
  find_imbalance(residual_);
  if (!has_contact) return;
  residual_ += mean_contact_force_;
  couples_->add(now_.middle, *stage.rows, solution.acting_normal(), solution.acting_tangential(), residual_);
}

/// Whether pressed points penetrate: the last correction may leave as much on surfaces that turn.
bool FiniteStrainIterate::any_penetrates(const StageSolution& solution, double correction) {
  const auto& [problem, acting, step, state, stages] = *task_;
  const double tolerance = extent_ * relative_penetration(stages.newton_tolerance());
  if (!problem.contact.follows_motion() || correction <= tolerance) return false;
  problem.gaps(now_.end, state.time + step, gap_);
  for (Index i = 0; i < gap_.size(); ++i)
    if (solution.normal_reaction[i] > 0.0 && gap_[i] < -tolerance) return true;
  return false;
}

bool FiniteStrainIterate::close_balance(const StageSolution& solution, double correction, bool may_refuse) {
  if (may_refuse && any_penetrates(solution, correction)) return false;
  Stage& stage = task_->middle_stage();
  find_residual(solution, stage);
  const double created = task_->problem.contact.follows_motion() ? correction * solution.normal_reaction.sum() : 0.0;
  const SolvedStep solved{task_->problem,
                          task_->step,
                          task_->state,
                          loads_,
                          solution,
                          now_.middle,
                          now_.end,
                          path_increment_,
                          inertial_increment_,
                          inertial_force_,
                          mean_contact_force_,
                          work_of_mean_,
                          work_at_end_,
                          created};
  return balance_.close(solved, residual_, may_refuse) == StepBalance::Verdict::closed;
}

void FiniteStrainIterate::finish(const StageSolution& solution, Vector& increment) {
  const auto& [problem, acting, step, state, stages] = *task_;
  Stage& stage = task_->middle_stage();
  increment = now_.end - state.displacement;
  before_ = state.displacement;
  if (problem.has_rotating_obstacles()) equations_.observe_step(problem, before_, state.time, now_.end, step, stage);
  state.displacement = now_.end;
  state.internal_strain = balance_.internal_strain();
  state.velocity = balance_.end_velocity();
  state.acceleration = (4.0 / (step * step)) * inertial_increment_ + (1.0 / step) * balance_.velocity_change();
  follow_without_inertia(problem, increment, step, state);
  equations_.store_contact(stage, solution, step, state);
  state.forces.support_reaction = balance_.support_reaction();
  loads_.store_varying(state.forces.varying_load);
  if (problem.has_damping()) {
    problem.damping.evaluate(increment, state.forces.damping_force);
    state.forces.damping_force *= 1.0 / step;
  }
  contact_.update_drift(problem, before_, state);
  balance_.finish(state);
}

}  // namespace ricochet
