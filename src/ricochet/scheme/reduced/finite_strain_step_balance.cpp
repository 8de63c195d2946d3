#include "ricochet/scheme/reduced/finite_strain_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/step/contact_conditions.hpp"

/// @file Balance of momentum and energy after the last iteration of a step.
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

BranchStep FiniteStrainStep::branch_step(double step, const State& state) const {
  return {middle_, path_increment_, state.displacement, end_, state.internal_strain, step};
}

/// Computes the contact forces of the last iteration, their works, and the residual R of all forces at the middle. The
/// reactions of supports are those for which R is zero there.
void FiniteStrainStep::find_residual(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage,
                                     const StageSolution& solution) {
  increment_ = end_ - state.displacement;
  if (problem.has_contact_dofs()) {
    if (problem.has_rotating_obstacles())
      equations_.observe_step(problem, state.displacement, state.time, end_, step, stage);
    const auto add = [&](const Vector& normal, const Vector& tangential, Vector& force) {
      force.setZero(problem.dof_count());
      stage.rows->add_force(normal, tangential, force);
    };
    add(solution.acting_normal(), solution.acting_tangential(), mean_contact_force_);
    add(solution.normal_reaction, solution.tangential_reaction, end_contact_force_);
    work_of_mean_ = on_contact(problem, mean_contact_force_, increment_) -
                    obstacle_work(stage, solution.acting_normal(), solution.acting_tangential(), step);
    work_at_end_ = on_contact(problem, end_contact_force_, increment_) -
                   obstacle_work(stage, solution.normal_reaction, solution.tangential_reaction, step);
  }
  find_imbalance(problem, step, state, residual_);
  if (problem.has_contact_dofs()) {
    residual_ += mean_contact_force_;
    if (problem.contact.follows_motion())
      problem.contact.geometry->add_couples(middle_, *stage.rows, solution.acting_normal(),
                                            solution.acting_tangential(), residual_);
  }
  support_reaction_.resize(problem.supports.size());
  for (Index i = 0; i < problem.supports.size(); ++i) {
    double& of_dof = residual_[problem.supports.dofs()[std::size_t(i)]];
    support_reaction_[i] = -std::exchange(of_dof, 0.0);
  }
}

/// Returns d' and, in `corrections_`, the works that differ from those of forces on increments.
double FiniteStrainStep::find_dissipation(const SemidiscreteProblem& problem, double step, const State& state,
                                          const StageSolution& solution) {
  corrections_ = {.viscous_dissipation = viscous_dissipation_};
  end_weight_ = 0.0;
  if (!contact_cells_) return 0.0;
  corrections_.load_work = loads_.work_of_change(problem.contact_dofs, state.displacement, end_, middle_);
  const bool is_pressed =
      !solution.normal_reaction.isZero(0.0) || !state.forces.normal_reaction.isZero(0.0) || loads_.acts_at_ends();
  end_weight_ = is_pressed ? solution.end_weight : 0.0;
  // The mean does no work along the path; the end reactions' part of it does their work.
  if (solution.end_weight != 1.0) corrections_.contact_work = end_weight_ * work_at_end_ - work_of_mean_;
  path_start_ = end_ - path_increment_;
  force_at_start_ = loads_.mean() + mean_contact_force_;
  if (loads_.acts_at_ends()) loads_.add_at_start(force_at_start_);
  double result =
      corrections_.contact_work + contact_cells_->energy(state.displacement) - contact_cells_->energy(path_start_);
  for (const Index dof : problem.contact_dofs)
    result += force_at_start_[dof] * (path_start_[dof] - state.displacement[dof]);
  const ViscousForce* const viscous = contact_cells_->viscous();
  if (viscous == nullptr) return result;
  const BranchStep branches = branch_step(step, state);
  return result + viscous->start_energy(branches, state.displacement) - viscous->start_energy(branches, path_start_);
}

/// Removes from the work of reactions what they supply because their rows are those of the iteration before: gaps at
/// the end of a step differ from zero there by at most the last correction.
void FiniteStrainStep::leave_out_created_work(const SemidiscreteProblem& problem, const StageSolution& solution,
                                              double correction) {
  if (!problem.contact.follows_motion()) return;
  const double largest = correction * solution.normal_reaction.sum();
  corrections_.contact_work -= std::clamp(work_at_end_, 0.0, largest);
}

/// Adds the velocity for which the momenta of a rigid body change by the impulses of the forces alone. Forces act at
/// the middle of the step, and the momentum belongs to its end.
void FiniteStrainStep::correct_momenta(const FreeMotion& body, double step) {
  const Index d = body.dimension(), centre = body.centre_node() * d, rotation = body.rotation_node() * d;
  velocity_change_.segment(centre, d) += (step / body.inertia().mass) * residual_.segment(centre, d);
  const SpaceVector arm = middle_.segment(centre, d) - end_.segment(centre, d);
  const SpaceVector torque = body.torque(residual_) + body.torque(arm, residual_);
  velocity_change_.segment(rotation, d) += body.velocity_of_momentum(step * torque, end_);
}

/// Computes V₁ and 𝒟. Throws Error(not_converged) if a cell is inverted at the end.
void FiniteStrainStep::find_stored_energy(const SemidiscreteProblem& problem, double step, const State& state) {
  const InternalForce& elastic = *problem.internal_force;
  const ViscousForce* const viscous = elastic.viscous();
  viscous_dissipation_ = viscous != nullptr ? viscous->advance_internal(branch_step(step, state), internal_) : 0.0;
  energy_ = stored_energy(elastic, end_, internal_);
  if (std::isfinite(energy_)) return;
  elastic.evaluate(end_, scratch_);  // throws the error that names the inverted cell
  throw Error(ErrorKind::not_converged, "the elastic energy at the end of the step is not finite");
}

/// Computes the energy that the step creates before velocities are corrected, less what it is known to dissipate.
double FiniteStrainStep::energy_defect(const SemidiscreteProblem& problem, double step, double kinetic_change) {
  mean_external_force_ = loads_.mean() + mean_contact_force_;
  loads_.add_pressure(mean_external_force_);
  double work = mean_external_force_.dot(increment_) + corrections_.load_work + corrections_.contact_work;
  if (problem.supports.size() > 0) work += problem.supports.work(support_reaction_, increment_);
  if (problem.has_damping()) {
    problem.damping.evaluate(increment_, damping_force_);
    work -= damping_force_.dot(increment_) / step;
  }
  return kinetic_change + (energy_ - energy_start_) + viscous_dissipation_ - work;
}

/// Gives the body exact momenta and, if it has a vibration to take it from, an exact balance of energy. Returns false
/// if the iterations must go on. Throws Error(not_converged) if the step creates energy.
bool FiniteStrainStep::close_balance(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage,
                                     const StageSolution& solution, double correction) {
  find_residual(problem, step, state, stage, solution);
  find_stored_energy(problem, step, state);
  const double dissipation = find_dissipation(problem, step, state, solution);
  leave_out_created_work(problem, solution, correction);
  const double kinetic_start = 0.5 * problem.mass.quadratic_form(state.velocity);
  end_velocity_ = state.velocity + (4.0 / step) * inertial_increment_;
  double kinetic_change = (4.0 / step) * (state.velocity + (2.0 / step) * inertial_increment_).dot(inertial_force_);
  velocity_correction_->start(end_);
  velocity_change_ = velocity_correction_->of_momenta(residual_, middle_, step, support_reaction_);
  const Vector* momentum_change = &velocity_correction_->momentum();
  if (!problem.free_bodies.empty()) {
    for (const auto& body : problem.free_bodies) correct_momenta(*body, step);
    problem.mass.multiply(velocity_change_, scratch_);
    momentum_change = &scratch_;
  }
  kinetic_change += (end_velocity_ + 0.5 * velocity_change_).dot(*momentum_change);
  end_velocity_ += velocity_change_;

  double defect = energy_defect(problem, step, kinetic_change);
  // Couples of contact forces, which cancel moments, may do work: the energy that is lost may be less than d'.
  if (end_weight_ > 0.0 && dissipation > 0.0)
    corrections_.numerical_dissipation = std::clamp(-defect, 0.0, dissipation);
  defect += corrections_.numerical_dissipation;
  const double size = std::max(kinetic_start, kinetic_start + kinetic_change) + energy_start_ + energy_;
  if (!(size > 0.0)) return true;  // everything is at rest
  return accept(defect / size, dissipation / size, size);
}

/// Corrects the velocity by a relative defect of the energy, see close_balance().
bool FiniteStrainStep::accept(double defect, double dissipation, double size) {
  const bool is_corrected =
      std::abs(defect) > thresholds_.tolerance && velocity_correction_->find(end_velocity_, -defect * size);
  if (log::enabled(log::Level::debug)) {
    log::debug(
        fmt::format("Newton: {} iterations, {:.2e} of the energy created, {:.2e} dissipated, velocities {}corrected",
                    progress_.iterations(), defect, dissipation, is_corrected ? "" : "not "));
  }
  // Reactions of the end that act over a step may lose energy, others conserve it.
  const double gained = end_weight_ > 0.0 ? defect : std::abs(defect);
  if (!is_corrected && gained > thresholds_.near_rounding && progress_.tighten()) return false;
  if (std::abs(defect) > thresholds_.max_corrected || (!is_corrected && gained > part_ * thresholds_.max_defect))
    throw Error(ErrorKind::not_converged,
                fmt::format("the step would {} {:.2g} of the energy, as strains change too much in it",
                            defect > 0.0 ? "create" : "lose", std::abs(defect)));
  if (is_corrected) {
    velocity_change_ += velocity_correction_->value();
    end_velocity_ += velocity_correction_->value();
  }
  corrections_.integration_error = is_corrected ? 0.0 : defect * size;
  return true;
}

}  // namespace ricochet
