#include "ricochet/scheme/reduced/finite_strain_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/scheme/reduced/massless_contact_step.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

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

/// The norm of a node's motion does not depend on the axes, so that rotated motions get the same advice.
double FiniteStrainStep::largest_motion(const SemidiscreteProblem& problem, const Vector& motion) {
  return motion.reshaped(problem.dimension, problem.nodes.cols()).colwise().norm().maxCoeff();
}

void FiniteStrainStep::analyse(const SemidiscreteProblem& problem, double step) {
  whole_step_ = step;
  flight_ = std::make_unique<FlightPrediction>(problem);
  balance_.analyse(problem, flight_->bodies());
  couples_ = std::make_unique<ContactCouples>(problem);
  contact_right_hand_side_.resize(Index(problem.contact_dofs.size()));
  contact_cells_ = problem.internal_force_at_contact();
  lowest_rules_ = problem.internal_force->path_rules();
  exact_.analyse(problem);
}

std::vector<OperatorCoefficients> FiniteStrainStep::operators(const SemidiscreteProblem& problem, double step,
                                                              ActingReaction acting) {
  OperatorCoefficients midpoint{.mass = 4.0 / (step * step), .stiffness = 1.0, .damping = 2.0 / step};
  midpoint.relaxation_step = step;
  if (!problem.has_contact_dofs()) return {midpoint};
  midpoint.condensed_operator = int(MasslessContactStep::condensed_stage);
  midpoint.acting = acting;
  OperatorCoefficients contact_operator{.mass = 0.0, .stiffness = 1.0, .damping = 0.0, .dofs = StageDofs::contact};
  contact_operator.relaxation_step = step;
  return {contact_operator, midpoint};
}

void FiniteStrainStep::start(const SemidiscreteProblem& problem, double step, const State& state) {
  loads_.start(problem, step, state);
  base_ = state.displacement + (0.5 * step) * state.velocity;
  flight_->predict(state.displacement, state.velocity, step, end_);
  middle_ = 0.5 * (state.displacement + end_);
  path_rules_ = lowest_rules_;
  path_increment_ = 2.0 * (end_ - middle_);
  problem.internal_force->raise_path_rules(middle_, path_increment_, path_rules_);
  raises_ = 0;
  acceleration_.restart();
  end_contact_force_.setZero(problem.dof_count());
  mean_contact_force_.setZero(problem.dof_count());
  balance_.start(problem, state, step / whole_step_);
}

/// Computes D and f(u₁).
void FiniteStrainStep::evaluate(const SemidiscreteProblem& problem, double step, const State& state) {
  const InternalForce& elastic = *problem.internal_force;
  path_increment_ = 2.0 * (end_ - middle_);
  elastic.path_force(middle_, path_increment_, path_rules_, force_);
  const BranchStep branches{middle_, path_increment_, state.displacement, end_, state.internal_strain, step};
  if (const ViscousForce* const viscous = elastic.viscous(); viscous != nullptr)
    viscous->add_mean_force(branches, force_);
  if (contact_cells_) contact_cells_->evaluate(end_, end_force_);
  if (contact_cells_ && contact_cells_->viscous() != nullptr)
    contact_cells_->viscous()->add_end_force(branches, end_force_);
  loads_.evaluate(problem, middle_, end_, contact_cells_ != nullptr);
}

/// Computes L̄ + P(x) − D − M (v₁−v₀)/h − (2/h) C (x−u₀): the force that is not balanced, without that of contact.
void FiniteStrainStep::find_imbalance(const SemidiscreteProblem& problem, double step, const State& state,
                                      Vector& force) {
  inertial_increment_ = middle_ - base_;
  problem.mass.multiply(inertial_increment_, inertial_force_);
  force = loads_.mean() - force_ - (4.0 / (step * step)) * inertial_force_;
  loads_.add_pressure(force);
  for (const auto& body : problem.free_bodies) body->add_gyroscopic_force(end_, state.velocity, step, force);
  if (!problem.has_damping()) return;
  half_increment_ = middle_ - state.displacement;
  problem.damping.evaluate(half_increment_, damping_force_);
  force -= (2.0 / step) * damping_force_;
}

/// Computes b of the stage, the residual at the middle without forces of contact, and δ at supports.
void FiniteStrainStep::balance_middle(const SemidiscreteProblem& problem, double step, const State& state,
                                      Stage& stage) {
  find_imbalance(problem, step, state, stage.right_hand_side.force);
  const auto half_way = [&](Index dof, double end) { return 0.5 * (state.displacement[dof] + end) - middle_[dof]; };
  equations_.prescribe(problem, state.time + step, half_way, stage);
}

/// Imposes contact at the end with the contact nodes, at δ = 0, at u_c1 + K_cc⁻¹ (L₁ + P_c(u₁) − f_c(u₁) − 2 b_c).
void FiniteStrainStep::require_contact(const SemidiscreteProblem& problem, ActingReaction acting, double step,
                                       const State& state, StageSolve& stages, Stage& stage) {
  contact_residual_ = loads_.mean() - end_force_ - 2.0 * stage.right_hand_side.force;
  if (loads_.acts_at_ends()) contact_residual_ += loads_.beside_at_end();
  problem.gather_contact(contact_residual_, contact_right_hand_side_);
  const Vector& shift = MasslessContactStep::solve_contact_nodes(problem, contact_right_hand_side_, stages);
  for (const Index dof : problem.contact_dofs) end_[dof] += shift[dof];
  // Conditions that follow the motion are linear about the end of the previous iteration: −m there, in place of δ = 0.
  linearization_motion_.setZero(end_.size());
  for (const Index dof : problem.contact_dofs) linearization_motion_[dof] = 0.5 * (last_end_[dof] - end_[dof]);
  contact_.require(problem, acting, step, state, end_, equations_, stage, &linearization_motion_);
  if (problem.contact.follows_motion()) stage.motion.reset();  // an iteration has the rows of its start
}

/// Updates x += δ, u₁ += 2δ, on contact nodes 2m.
FiniteStrainStep::Iteration FiniteStrainStep::correct(const SemidiscreteProblem& problem, const State& state,
                                                      const StageSolution& solution) {
  middle_ += solution.increment;
  next_end_ = 2.0 * middle_ - state.displacement;
  for (const Index dof : problem.contact_dofs) next_end_[dof] = end_[dof] + 2.0 * solution.contact_increment[dof];
  motion_ = next_end_ - last_end_;
  Iteration iteration{largest_motion(problem, motion_), 0.0};
  motion_ = 2.0 * (middle_ - last_middle_);
  iteration.correction = std::max(iteration.correction, largest_motion(problem, motion_));
  end_ = next_end_;
  reactions_.normal = solution.normal_reaction;
  reactions_.tangential = solution.tangential_reaction;
  reactions_.acting_normal = solution.acting_normal();
  reactions_.acting_tangential = solution.acting_tangential();
  // Increment of the step less that of a free flight: the effect of forces.
  motion_ = 2.0 * (middle_ - base_);
  iteration.increment = largest_motion(problem, motion_);
  return iteration;
}

/// Accelerates the iterations of displacements, together with the reactions that act on them.
void FiniteStrainStep::accelerate(const SemidiscreteProblem& problem, const State& state) {
  const auto contact = Index(problem.contact_dofs.size());
  const Index middle = middle_.size(), positions = middle + contact, points = reactions_.normal.size(),
              slips = reactions_.tangential.size();
  image_.resize(positions + 2 * (points + slips));
  image_.head(middle) = middle_;
  problem.gather_contact(end_, image_.segment(middle, contact));
  image_.tail(2 * (points + slips)) << reactions_.normal, reactions_.acting_normal, reactions_.tangential,
      reactions_.acting_tangential;
  point_ = image_;
  point_.head(middle) = last_middle_;
  problem.gather_contact(last_end_, point_.segment(middle, contact));
  acceleration_.advance(point_, image_, image_);
  middle_ = image_.head(middle);
  end_ = 2.0 * middle_ - state.displacement;
  problem.scatter_contact(image_.segment(middle, contact), end_);
  reactions_.normal = image_.segment(positions, points);
  reactions_.acting_normal = image_.segment(positions + points, points);
  reactions_.tangential = image_.segment(positions + 2 * points, slips);
  reactions_.acting_tangential = image_.tail(slips);
}

void FiniteStrainStep::finish(const SemidiscreteProblem& problem, double step, State& state, Stage& stage,
                              const StageSolution& solution, Vector& increment) {
  increment = end_ - state.displacement;
  before_ = state.displacement;
  if (problem.has_rotating_obstacles()) equations_.observe_step(problem, before_, state.time, end_, step, stage);
  state.displacement = end_;
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

/// Computes the contact forces of the last iteration, their works, and the residual R of all forces at the middle.
void FiniteStrainStep::find_residual(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage,
                                     const StageSolution& solution) {
  const bool has_contact = problem.has_contact_dofs();
  if (has_contact) {
    if (problem.has_rotating_obstacles())
      equations_.observe_step(problem, state.displacement, state.time, end_, step, stage);
    motion_ = end_ - state.displacement;
    const auto add = [&](const Vector& normal, const Vector& tangential, Vector& force) {
      force.setZero(problem.dof_count());
      stage.rows->add_force(normal, tangential, force);
      return on_contact(problem, force, motion_) - obstacle_work(stage, normal, tangential, step);
    };
    work_of_mean_ = add(solution.acting_normal(), solution.acting_tangential(), mean_contact_force_);
    work_at_end_ = add(solution.normal_reaction, solution.tangential_reaction, end_contact_force_);
  }
  find_imbalance(problem, step, state, residual_);
  if (!has_contact) return;
  residual_ += mean_contact_force_;
  couples_->add(middle_, *stage.rows, solution.acting_normal(), solution.acting_tangential(), residual_);
}

/// Closes the balance of momentum and energy. Returns false if the iterations must go on.
bool FiniteStrainStep::close_balance(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage,
                                     const StageSolution& solution, double correction, NewtonProgress& progress) {
  find_residual(problem, step, state, stage, solution);
  const double created = problem.contact.follows_motion() ? correction * solution.normal_reaction.sum() : 0.0;
  const SolvedStep solved{problem,
                          step,
                          state,
                          loads_,
                          solution,
                          middle_,
                          end_,
                          path_increment_,
                          inertial_increment_,
                          inertial_force_,
                          mean_contact_force_,
                          work_of_mean_,
                          work_at_end_,
                          created};
  if (balance_.close(solved, residual_, !progress.is_tight()) == StepBalance::Verdict::closed) return true;
  progress.tighten();
  return false;
}

/// Solves the linear stage of an iteration.
const StageSolution& FiniteStrainStep::solve_iteration(const SemidiscreteProblem& problem, ActingReaction acting,
                                                       double step, const State& state, StageSolve& stages) {
  const std::size_t number = MasslessContactStep::midpoint_stage(problem);
  Stage& stage = stages.stage(number);
  last_middle_ = middle_;
  last_end_ = end_;
  balance_middle(problem, step, state, stage);
  if (!problem.has_contact_dofs()) {
    stage.conditions.eligible.clear();
    stage.motion.reset();
  } else {
    require_contact(problem, acting, step, state, stages, stage);
  }
  const StageSolution* solution = nullptr;
  try {
    solution = &stages.solve(number);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::not_converged) throw_if_inverted(problem);
    throw;
  }
  return *solution;
}

double FiniteStrainStep::rounding_of_positions(const SemidiscreteProblem& problem) const {
  const double size = problem.nodes.cwiseAbs().maxCoeff() + end_.lpNorm<Eigen::Infinity>();
  return 8.0 * std::numeric_limits<double>::epsilon() * size;
}

void FiniteStrainStep::advance_with_kept_factor(const SemidiscreteProblem& problem, ActingReaction acting, double step,
                                                State& state, StageSolve& stages, FailureMode mode, Vector& increment) {
  start(problem, step, state);
  stages.rotate_operators(middle_);
  evaluate(problem, step, state);
  progress_.start(rounding_of_positions(problem), stages.renewal_price(), stages.newton_tolerance());
  Stage& stage = stages.stage(MasslessContactStep::midpoint_stage(problem));
  while (true) {
    const StageSolution& solution = solve_iteration(problem, acting, step, state, stages);
    const Iteration iteration = correct(problem, state, solution);
    const NewtonProgress::Advice advice = progress_.assess(iteration.correction, iteration.increment);
    if (progress_.wants_acceleration() && advice == NewtonProgress::Advice::proceed) accelerate(problem, state);
    const bool is_halved = evaluate_with_halving(problem, step, state);
    // Reactions of an increment that was halved are not its own: contact conditions hold for the whole one.
    const bool is_done = advice == NewtonProgress::Advice::done && !is_halved;
    const bool is_near = iteration.correction <= thresholds_.near_solution * iteration.increment;
    if ((is_done || is_near) && raise_rules(problem, is_done)) {
      evaluate(problem, step, state);
      progress_.restart();
      acceleration_.restart();
      continue;
    }
    if (!is_done) {
      apply_advice(problem, advice, iteration, mode, stages);
      continue;
    }
    try {
      if (close_balance(problem, step, state, stage, solution, iteration.correction, progress_)) {
        finish(problem, step, state, stage, solution, increment);
        return;
      }
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged || mode == FailureMode::early || !freeze_pairs(problem)) throw;
    }
  }
}

}  // namespace ricochet
