#include "ricochet/scheme/reduced/step_balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"

namespace ricochet {

void StepBalance::analyse(const SemidiscreteProblem& problem, const BodyRotations& bodies) {
  velocity_correction_ = std::make_unique<VelocityCorrection>(problem, bodies);
  contact_cells_ = problem.internal_force_at_contact();
}

void StepBalance::start(const SemidiscreteProblem& problem, const State& state, double part) {
  part_ = std::clamp(part, thresholds_.min_part, 1.0);
  energy_start_ = last_step_ == state.step
                      ? last_energy_
                      : stored_energy(*problem.internal_force, state.displacement, state.internal_strain);
}

void StepBalance::finish(const State& state) {
  last_step_ = state.step + 1;
  last_energy_ = energy_end_;
}

StepBalance::Verdict StepBalance::close(const SolvedStep& solved, Vector& residual, bool may_open) {
  increment_ = solved.end - solved.state.displacement;
  take_support_reactions(solved.problem, residual);
  find_stored_energy(solved);
  const double dissipation = find_dissipation(solved);
  const double kinetic_start = 0.5 * solved.problem.mass.quadratic_form(solved.state.velocity);
  const double kinetic_change = correct_momenta(solved, residual);
  double defect = energy_defect(solved, kinetic_change);
  // Velocities with exact momenta may have more energy, so that less than d' is lost.
  if (end_weight_ > 0.0 && dissipation > 0.0)
    corrections_.numerical_dissipation = std::clamp(-defect, 0.0, dissipation);
  defect += corrections_.numerical_dissipation;
  const double size = std::max(kinetic_start, kinetic_start + kinetic_change) + energy_start_ + energy_end_;
  if (size == 0.0) return Verdict::closed;  // everything is at rest
  corrections_.energy_at_end = kinetic_start + kinetic_change + energy_end_;
  return correct_energy(defect / size, dissipation / size, size, may_open);
}

/// The reactions of supports are those for which R is zero there.
void StepBalance::take_support_reactions(const SemidiscreteProblem& problem, Vector& residual) {
  support_reaction_.resize(problem.supports.size());
  for (Index i = 0; i < problem.supports.size(); ++i) {
    double& of_dof = residual[problem.supports.dofs()[std::size_t(i)]];
    support_reaction_[i] = -std::exchange(of_dof, 0.0);
  }
}

/// Computes A₁, V₁ and 𝒟.
void StepBalance::find_stored_energy(const SolvedStep& solved) {
  const InternalForce& elastic = *solved.problem.internal_force;
  const ViscousForce* const viscous = elastic.viscous();
  viscous_dissipation_ = viscous != nullptr ? viscous->advance_internal(solved.branches(), internal_) : 0.0;
  energy_end_ = stored_energy(elastic, solved.end, internal_);
  if (std::isfinite(energy_end_)) return;
  elastic.evaluate(solved.end, force_at_start_);  // throws the error that names the inverted cell
  throw Error(ErrorKind::not_converged, "the elastic energy at the end of the step is not finite");
}

/// Returns d' and, in `corrections_`, the works that differ from those of forces on increments.
double StepBalance::find_dissipation(const SolvedStep& solved) {
  const State& state = solved.state;
  const std::vector<Index>& contact_dofs = solved.problem.contact_dofs;
  corrections_ = {.viscous_dissipation = viscous_dissipation_};
  end_weight_ = 0.0;
  if (!contact_cells_) return 0.0;
  corrections_.load_work = solved.loads.work_of_change(contact_dofs, state.displacement, solved.end, solved.middle);
  const bool is_pressed = !solved.solution.normal_reaction.isZero(0.0) || !state.forces.normal_reaction.isZero(0.0) ||
                          solved.loads.acts_at_ends();
  end_weight_ = is_pressed ? solved.solution.end_weight : 0.0;
  // The mean does no work along the path; the end reactions' part of it does their work.
  if (solved.solution.end_weight != 1.0)
    corrections_.contact_work = end_weight_ * solved.work_at_end - solved.work_of_mean;
  path_start_ = solved.end - solved.path_increment;
  force_at_start_ = solved.loads.mean() + solved.mean_contact_force;
  if (solved.loads.acts_at_ends()) solved.loads.add_at_start(force_at_start_);
  double result =
      corrections_.contact_work + contact_cells_->energy(state.displacement) - contact_cells_->energy(path_start_);
  for (const Index dof : contact_dofs) result += force_at_start_[dof] * (path_start_[dof] - state.displacement[dof]);
  // Gaps at the end differ from zero by the last correction at most; the work that pressed points receive is removed.
  if (solved.max_created_work > 0.0)
    corrections_.contact_work -= end_weight_ * std::clamp(solved.work_at_end, 0.0, solved.max_created_work);
  const ViscousForce* const viscous = contact_cells_->viscous();
  if (viscous == nullptr) return result;
  const BranchStep branches = solved.branches();
  return result + viscous->start_energy(branches, state.displacement) - viscous->start_energy(branches, path_start_);
}

/// Computes the velocity at the end with exact momenta. Returns the change of the kinetic energy over the step.
double StepBalance::correct_momenta(const SolvedStep& solved, const Vector& residual) {
  const double step = solved.step;
  const Vector& start_velocity = solved.state.velocity;
  end_velocity_ = start_velocity + (4.0 / step) * solved.inertial_increment;
  double kinetic_change =
      (4.0 / step) * (start_velocity + (2.0 / step) * solved.inertial_increment).dot(solved.inertial_force);
  velocity_correction_->start(solved.end);
  velocity_change_ = velocity_correction_->of_momenta(residual, solved.middle, step, support_reaction_);
  const Vector* momentum_change = &velocity_correction_->momentum();
  if (!solved.problem.free_bodies.empty()) {
    for (const auto& body : solved.problem.free_bodies) correct_momenta_of(*body, solved, residual);
    solved.problem.mass.multiply(velocity_change_, momentum_change_);
    momentum_change = &momentum_change_;
  }
  kinetic_change += (end_velocity_ + 0.5 * velocity_change_).dot(*momentum_change);
  end_velocity_ += velocity_change_;
  return kinetic_change;
}

/// Adds the velocity for which the momenta of a rigid body change by the impulses of the forces alone. Forces act at
/// the middle of the step, and the momentum belongs to its end.
void StepBalance::correct_momenta_of(const FreeMotion& body, const SolvedStep& solved, const Vector& residual) {
  const Index d = body.dimension(), centre = body.centre_node() * d, rotation = body.rotation_node() * d;
  velocity_change_.segment(centre, d) += (solved.step / body.inertia().mass) * residual.segment(centre, d);
  const SpaceVector arm = solved.middle.segment(centre, d) - solved.end.segment(centre, d);
  const SpaceVector torque = body.torque(residual) + body.torque(arm, residual);
  velocity_change_.segment(rotation, d) += body.velocity_of_momentum(solved.step * torque, solved.end);
}

/// Returns E₁ − E₀ + 𝒟 less the works of all forces, with exact momenta: −d', −R·Δ̂ and smaller terms.
double StepBalance::energy_defect(const SolvedStep& solved, double kinetic_change) {
  mean_external_force_ = solved.loads.mean() + solved.mean_contact_force;
  solved.loads.add_pressure(mean_external_force_);
  double work = mean_external_force_.dot(increment_) + corrections_.load_work + corrections_.contact_work;
  if (solved.problem.supports.size() > 0) work += solved.problem.supports.work(support_reaction_, increment_);
  if (solved.problem.has_damping()) {
    solved.problem.damping.evaluate(increment_, damping_force_);
    work -= damping_force_.dot(increment_) / solved.step;
  }
  return kinetic_change + (energy_end_ - energy_start_) + viscous_dissipation_ - work;
}

/// Corrects the velocity by a defect of the energy. Defect and dissipation are relative to `size`.
StepBalance::Verdict StepBalance::correct_energy(double defect, double dissipation, double size, bool may_open) {
  const bool is_corrected =
      std::abs(defect) > thresholds_.tolerance && velocity_correction_->find(end_velocity_, -defect * size);
  if (log::enabled(log::Level::debug)) {
    log::debug(fmt::format("balance of a step: {:.2e} of the energy created, {:.2e} dissipated, velocities {}corrected",
                           defect, dissipation, is_corrected ? "" : "not "));
  }
  // Reactions of the end that act over a step may lose energy, others conserve it.
  const double gained = end_weight_ > 0.0 ? defect : std::abs(defect);
  if (may_open && !is_corrected && gained > thresholds_.near_rounding) return Verdict::open;
  if (!(std::abs(defect) <= part_ * thresholds_.max_corrected) ||
      (!is_corrected && gained > part_ * thresholds_.max_defect))
    throw Error(ErrorKind::not_converged,
                fmt::format("the step would {} {:.2g} of the energy, as strains change too much in it",
                            defect > 0.0 ? "create" : "lose", std::abs(defect)));
  if (is_corrected) {
    velocity_change_ += velocity_correction_->value();
    end_velocity_ += velocity_correction_->value();
    corrections_.velocity_correction = -defect * size;
    corrections_.energy_at_end += corrections_.velocity_correction;
  }
  corrections_.integration_error = is_corrected ? 0.0 : defect * size;
  return Verdict::closed;
}

}  // namespace ricochet
