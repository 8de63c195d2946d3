#include "ricochet/scheme/reduced/finite_strain_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/scheme/reduced/massless_contact_step.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

double on_contact(const SemidiscreteProblem& problem, const Vector& a, const Vector& b) {
  double sum = 0.0;
  for (const Index dof : problem.contact_dofs) sum += a[dof] * b[dof];
  return sum;
}

/// Work of forces on rigid bodies that move freely: part of the kinetic energy, as on everything that has inertia.
double on_free_bodies(const SemidiscreteProblem& problem, const Vector& force, const Vector& end, const Vector& start) {
  double sum = 0.0;
  for (Index dof = problem.cell_node_count() * problem.dimension; dof < end.size(); ++dof)
    sum += force[dof] * (end[dof] - start[dof]);
  return sum;
}

}  // namespace

void FiniteStrainStep::analyse(const SemidiscreteProblem& problem, double step) {
  whole_step_ = step;
  flight_ = std::make_unique<FlightPrediction>(problem);
  velocity_correction_ = std::make_unique<VelocityCorrection>(problem, flight_->bodies());
  contact_right_hand_side_.resize(Index(problem.contact_dofs.size()));
  contact_cells_ = problem.internal_force_at_contact();
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
  jumped_displacement_ = state.displacement;
  contact_energy_start_.reset();
  sigma_.start();
  kinetic_ = kinetic_start_ = 0.5 * problem.mass.quadratic_form(state.velocity);
  converged_ = corrects_velocity_ = false;
  energy_defect_size_ = std::numeric_limits<double>::infinity();
  part_ = std::clamp(step / whole_step_, thresholds_.min_part, 1.0);
  stalled_iterations_ = 0;
  energy_defect_ = end_weight_ = dissipation_ = viscous_dissipation_ = work_at_end_ = obstacle_work_ = 0.0;
  has_reactions_ = false;
  acceleration_.restart();
  if (problem.contact.follows_motion()) lagged_.start(state);
  lagged_row_force_.setZero(problem.dof_count());
  end_contact_force_.setZero(problem.dof_count());
  mean_contact_force_.setZero(problem.dof_count());
  energy_start_ = energy_step_ == state.step
                      ? last_energy_
                      : stored_energy(*problem.internal_force, state.displacement, state.internal_strain);
}

double FiniteStrainStep::tolerance() const {
  return sigma_.is_weak() ? thresholds_.weak_tolerance : thresholds_.tolerance;
}

/// Computes f̄, p, f(u₁), and σ from the balance of energy at these.
void FiniteStrainStep::evaluate(const SemidiscreteProblem& problem, double step, const State& state, bool near) {
  const InternalForce& elastic = *problem.internal_force;
  const ViscousForce* const viscous = elastic.viscous();
  increment_ = end_ - state.displacement;
  const BranchStep branches{middle_, increment_, end_, state.internal_strain, step};
  if (near || sigma_.value() != 0.0) {
    elastic.mean_forces(middle_, increment_, force_, strain_force_);
  } else {
    elastic.mean_force(middle_, increment_, force_);
  }
  if (viscous != nullptr) viscous->add_mean_force(branches, force_);
  if (contact_cells_) contact_cells_->evaluate(end_, end_force_);
  if (contact_cells_ && contact_cells_->viscous() != nullptr)
    contact_cells_->viscous()->add_end_force(branches, end_force_);
  loads_.evaluate(problem, middle_, end_, contact_cells_ != nullptr);
  if (!near) return;
  if (viscous != nullptr) viscous_dissipation_ = viscous->advance_internal(branches, internal_);
  energy_ = stored_energy(elastic, end_, internal_);
  if (!std::isfinite(energy_)) {
    elastic.evaluate(end_, scratch_);  // throws the error that names the inverted cell
    throw Error(ErrorKind::not_converged, "the elastic energy at the end of the step is not finite");
  }
  load_work_ = contact_cells_ ? loads_.work_of_change(problem.contact_dofs, state.displacement, end_, middle_) : 0.0;
  // P(x) on contact nodes is in neither term, since the work of D contains it, too.
  const double required = (energy_ - energy_start_) + viscous_dissipation_ -
                          on_contact(problem, loads_.mean(), increment_) - load_work_ - obstacle_work_ -
                          end_weight_ * (work_at_end_ - dissipation_);
  mean_external_force_ = loads_.mean() + mean_contact_force_;
  const double has = force_.dot(increment_) - on_contact(problem, mean_external_force_, increment_);
  const double unit = strain_force_.dot(increment_);
  energy_defect_ = required - has - sigma_.value() * unit;
  const double size = std::abs(energy_start_ + energy_);
  // A defect at the level of rounding carries no information, least of all if the body hardly moves.
  if (std::abs(energy_defect_) <= tolerance() * size || unit <= thresholds_.tolerance * thresholds_.tolerance * size)
    return;
  if (sigma_.choose((required - has) / unit, energy_defect_, thresholds_.near_rounding * size, converged_))
    progress_.restart();  // the next correction is due to σ
}

/// Computes b of the stage: the residual at the middle.
void FiniteStrainStep::balance(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage) {
  inertial_increment_ = middle_ - base_;
  problem.mass.multiply(inertial_increment_, inertial_force_);
  kinetic_ = kinetic_start_ + (4.0 / step) * (state.velocity + (2.0 / step) * inertial_increment_).dot(inertial_force_);
  stage.right_hand_side.force = loads_.mean() - force_ - (4.0 / (step * step)) * inertial_force_;
  loads_.add_pressure(stage.right_hand_side.force);
  for (const auto& body : problem.free_bodies)
    body->add_gyroscopic_force(end_, state.velocity, step, stage.right_hand_side.force);
  if (sigma_.value() != 0.0) stage.right_hand_side.force -= sigma_.value() * strain_force_;
  if (problem.has_damping()) {
    half_increment_ = middle_ - state.displacement;
    problem.damping.evaluate(half_increment_, damping_force_);
    stage.right_hand_side.force -= (2.0 / step) * damping_force_;
  }
  if (problem.contact.follows_motion() && has_reactions_) {
    lagged_row_force_.setZero();
    lagged_.add_difference(reactions_.normal, reactions_.tangential, lagged_row_force_);
    stage.right_hand_side.force += lagged_row_force_;
    problem.contact.geometry->add_couples(middle_, *lagged_.exact(), reactions_.acting_normal,
                                          reactions_.acting_tangential, stage.right_hand_side.force);
  }
  const auto half_way = [&](Index dof, double end) { return 0.5 * (state.displacement[dof] + end) - middle_[dof]; };
  equations_.prescribe(problem, state.time + step, half_way, stage);
}

/// Imposes contact at the end with the contact nodes, at δ = 0, at u_c1 + K_cc⁻¹ (L₁ + P_c(u₁) − f_c(u₁) − 2 b_c); b
/// and L₁ contain the force of lagged rows.
void FiniteStrainStep::require_contact(const SemidiscreteProblem& problem, ActingReaction acting, double step,
                                       const State& state, StageSolve& stages, Stage& stage) {
  contact_residual_ = loads_.mean() - end_force_ - 2.0 * stage.right_hand_side.force + lagged_row_force_;
  if (loads_.acts_at_ends()) contact_residual_ += loads_.beside_at_end();
  problem.gather_contact(contact_residual_, contact_right_hand_side_);
  const Vector& shift = MasslessContactStep::solve_contact_nodes(problem, contact_right_hand_side_, stages);
  for (const Index dof : problem.contact_dofs) end_[dof] += shift[dof];
  lagged_.release();
  contact_.require(problem, acting, step, state, end_, equations_, stage);
  if (!problem.contact.follows_motion()) return;
  // Conditions are linear about the end of the previous iteration: −m there, in place of δ = 0.
  linearization_motion_.setZero(end_.size());
  for (const Index dof : problem.contact_dofs) linearization_motion_[dof] = 0.5 * (last_end_[dof] - end_[dof]);
  linearize_contact(problem, linearization_motion_, stage);
  lagged_.replace_rows(linearization_motion_, stage);
}

/// Updates x += δ, u₁ += 2δ, on contact nodes 2m.
FiniteStrainStep::Iteration FiniteStrainStep::correct(const SemidiscreteProblem& problem, const State& state,
                                                      const StageSolution& solution) {
  middle_ += solution.increment;
  next_end_ = 2.0 * middle_ - state.displacement;
  for (const Index dof : problem.contact_dofs) next_end_[dof] = end_[dof] + 2.0 * solution.contact_increment[dof];
  Iteration iteration{(next_end_ - last_end_).lpNorm<Eigen::Infinity>(), 0.0};
  iteration.correction = std::max(iteration.correction, 2.0 * (middle_ - last_middle_).lpNorm<Eigen::Infinity>());
  end_ = next_end_;
  has_reactions_ = true;
  reactions_.normal = solution.normal_reaction;
  reactions_.tangential = solution.tangential_reaction;
  reactions_.acting_normal = solution.acting_normal();
  reactions_.acting_tangential = solution.acting_tangential();
  // Increment of the step less that of a free flight: the effect of forces.
  iteration.increment = 2.0 * (middle_ - base_).lpNorm<Eigen::Infinity>();
  return iteration;
}

/// Accelerates corrections that hardly shrink: displacements, with the reactions that acted on them.
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

/// Computes Hᵀρ and Hᵀρ̄ and, if the end reactions have a part in the mean, performs one iteration for u₀ + J.
void FiniteStrainStep::update_start(const SemidiscreteProblem& problem, double step, const State& state,
                                    StageSolve& stages, Stage& stage, const StageSolution& solution) {
  end_contact_force_.setZero();
  stage.rows->add_force(solution.normal_reaction, solution.tangential_reaction, end_contact_force_);
  mean_contact_force_.setZero();
  stage.rows->add_force(solution.acting_normal(), solution.acting_tangential(), mean_contact_force_);
  if (problem.contact.follows_motion()) {
    problem.contact.geometry->add_couples(middle_, *stage.rows, solution.acting_normal(), solution.acting_tangential(),
                                          mean_contact_force_);
  }
  if (problem.has_rotating_obstacles())
    equations_.observe_step(problem, state.displacement, state.time, end_, step, stage);
  obstacle_work_ = obstacle_work(stage, solution.acting_normal(), solution.acting_tangential(), step) -
                   on_free_bodies(problem, mean_contact_force_, end_, state.displacement);
  end_weight_ = solution.end_weight;
  dissipation_ = work_at_end_ = 0.0;
  if (end_weight_ == 0.0 || (solution.normal_reaction.isZero(0.0) && state.forces.normal_reaction.isZero(0.0))) {
    if (!loads_.acts_at_ends()) {
      jumped_displacement_ = state.displacement;
      end_weight_ = 0.0;
      return;
    }
  }
  contact_cells_->evaluate(jumped_displacement_, jump_force_);
  const ViscousForce* const viscous = contact_cells_->viscous();
  increment_ = end_ - state.displacement;
  const BranchStep branches{middle_, increment_, end_, state.internal_strain, step};
  if (viscous != nullptr) viscous->add_start_force(branches, jumped_displacement_, jump_force_);
  at_start_ = loads_.mean() + end_contact_force_;
  if (loads_.acts_at_ends()) loads_.add_at_start(at_start_);
  start_residual_ = at_start_ - jump_force_;
  problem.gather_contact(start_residual_, contact_right_hand_side_);
  const Vector& change = MasslessContactStep::solve_contact_nodes(problem, contact_right_hand_side_, stages);
  for (const Index dof : problem.contact_dofs) jumped_displacement_[dof] += change[dof];
  // d: both energies are those of the cells at contact nodes, as the others are equal.
  jump_ = jumped_displacement_ - state.displacement;
  if (!contact_energy_start_) contact_energy_start_ = contact_cells_->energy(state.displacement);
  dissipation_ =
      on_contact(problem, at_start_, jump_) - (contact_cells_->energy(jumped_displacement_) - *contact_energy_start_);
  if (viscous != nullptr)
    dissipation_ -=
        viscous->start_energy(branches, jumped_displacement_) - viscous->start_energy(branches, state.displacement);
  work_at_end_ = on_contact(problem, end_contact_force_, increment_) -
                 obstacle_work(stage, solution.normal_reaction, solution.tangential_reaction, step) +
                 on_free_bodies(problem, end_contact_force_, end_, state.displacement);
}

/// Work of reactions on the motion of the obstacles over the step.
double FiniteStrainStep::obstacle_work(Stage& stage, const Vector& normal, const Vector& tangential, double step) {
  if (stage.obstacle.normal.size() == 0) return 0.0;
  project_motion(*stage.rows, stage.obstacle);
  return step * (normal.dot(stage.obstacle.normal) -
                 (tangential.size() > 0 ? tangential.dot(stage.obstacle.tangential) : 0.0));
}

void FiniteStrainStep::finish(const SemidiscreteProblem& problem, double step, State& state, Stage& stage,
                              const StageSolution& solution, Vector& increment) {
  increment = end_ - state.displacement;
  before_ = state.displacement;
  if (problem.has_rotating_obstacles()) equations_.observe_step(problem, before_, state.time, end_, step, stage);
  inertial_increment_ = middle_ - base_;
  state.displacement = end_;
  state.internal_strain = internal_;
  state.velocity += (4.0 / step) * inertial_increment_;
  state.acceleration = (4.0 / (step * step)) * inertial_increment_;
  if (corrects_velocity_) {
    state.velocity += velocity_correction_->value();
    state.acceleration += (1.0 / step) * velocity_correction_->value();
  }
  follow_without_inertia(problem, increment, step, state);
  equations_.store_contact(stage, solution, step, state);
  loads_.store_varying(state.forces.varying_load);
  if (problem.has_damping()) {
    problem.damping.evaluate(increment, state.forces.damping_force);
    state.forces.damping_force *= 1.0 / step;
  }
  contact_.update_drift(problem, before_, state);
  if (problem.contact.follows_motion()) lagged_.remember(state);
  energy_step_ = state.step + 1;
  last_energy_ = energy_;
  corrections_ = {.load_work = load_work_,
                  .numerical_dissipation = end_weight_ * dissipation_,
                  .integration_error = corrects_velocity_ ? 0.0 : energy_defect_,
                  .viscous_dissipation = viscous_dissipation_};
  if (end_weight_ == 1.0) return;
  // The mean does no work along the path; the end reactions' part of it does their work.
  corrections_.contact_work = end_weight_ * work_at_end_ - (mean_contact_force_.dot(increment) - obstacle_work_);
}

/// Solves the linear stage of an iteration.
const StageSolution& FiniteStrainStep::solve_iteration(const SemidiscreteProblem& problem, ActingReaction acting,
                                                       double step, const State& state, StageSolve& stages) {
  const std::size_t number = MasslessContactStep::midpoint_stage(problem);
  Stage& stage = stages.stage(number);
  last_middle_ = middle_;
  last_end_ = end_;
  balance(problem, step, state, stage);
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
  if (lagged_.exact() != nullptr) stage.rows = lagged_.exact();
  return *solution;
}

void FiniteStrainStep::advance(const SemidiscreteProblem& problem, ActingReaction acting, double step, State& state,
                               StageSolve& stages, Vector& increment) {
  start(problem, step, state);
  stages.rotate_operators(middle_);
  evaluate(problem, step, state, false);
  progress_.start(8.0 * std::numeric_limits<double>::epsilon() *
                  (problem.nodes.cwiseAbs().maxCoeff() + end_.lpNorm<Eigen::Infinity>()));
  Stage& stage = stages.stage(MasslessContactStep::midpoint_stage(problem));
  while (true) {
    const StageSolution& solution = solve_iteration(problem, acting, step, state, stages);
    const Iteration iteration = correct(problem, state, solution);
    const NewtonProgress::Advice advice = progress_.assess(iteration.correction, iteration.increment);
    // Once displacements have converged, which lasts while σ is sought, the solution is that of the equations.
    if (!converged_ && progress_.wants_acceleration() && advice == NewtonProgress::Advice::proceed)
      accelerate(problem, state);
    converged_ = converged_ || advice == NewtonProgress::Advice::done;
    if (problem.has_contact_dofs()) update_start(problem, step, state, stages, stage, solution);
    const bool near = iteration.correction <= thresholds_.near_solution * iteration.increment || converged_;
    evaluate_with_halving(problem, step, state, near);
    try {
      if (is_balanced(step, state, iteration, near)) {
        finish(problem, step, state, stage, solution, increment);
        return;
      }
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged || !freeze_pairs(problem)) throw;
      converged_ = false;
      stalled_iterations_ = 0;
      energy_defect_size_ = std::numeric_limits<double>::infinity();
      sigma_.start();
      continue;
    }
    if (converged_ && sigma_.is_weak()) {  // with another σ now
      converged_ = false;
      progress_.restart();
    } else if (!converged_) {
      apply_advice(problem, advice, iteration, stages);
    }
  }
}

}  // namespace ricochet
