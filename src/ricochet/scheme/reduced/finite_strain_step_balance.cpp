#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/scheme/reduced/finite_strain_step.hpp"

/// @file Energy balance of a step.
namespace ricochet {

/// Returns whether displacements have converged and the energy is balanced, as far as rounding of forces and energies
/// permits. A step that creates or loses energy is not acceptable: throws Error(not_converged).
bool FiniteStrainStep::is_balanced(double step, const State& state, const Iteration& iteration, bool near) {
  if (!near) return false;  // the defect is not known
  // In a short one contact nodes, which have no inertia, snap to another equilibrium, and the energy that this releases
  // or absorbs is exchanged with the motion.
  const bool is_short = step <= thresholds_.short_part * whole_step_;
  const double size = std::max(kinetic_start_, kinetic_) + energy_start_ + energy_;
  const bool is_exact = std::abs(energy_defect_) <= tolerance() * size;
  const bool is_stalled = std::abs(energy_defect_) > 0.5 * energy_defect_size_;
  stalled_iterations_ = converged_ && is_stalled ? stalled_iterations_ + 1 : 0;
  energy_defect_size_ = std::abs(energy_defect_);
  // Far from rounding one iteration may bring little, and the next one much.
  const int max_stalled_iterations = energy_defect_size_ <= thresholds_.slow_convergence * size ? 1 : 2;
  const bool is_last = sigma_.is_weak() ? sigma_.is_settled() : stalled_iterations_ >= max_stalled_iterations;
  if (log::enabled(log::Level::debug)) {
    log::debug(fmt::format(
        "Newton: iteration {}, correction {:.2e} of {:.2e}, sigma {:.2e}, {:.2e} of the energy is missing, weight of "
        "the end reactions {:.3g}",
        progress_.iterations(), iteration.correction, iteration.increment, sigma_.value(), energy_defect_ / size,
        end_weight_));
  }
  if (!converged_) return false;
  if (!is_exact && !is_last) return false;
  const bool is_done =
      is_exact || energy_defect_size_ <= thresholds_.near_rounding * size ||
      (energy_defect_size_ <= (is_short ? thresholds_.max_snapped : thresholds_.max_corrected) * size &&
       correct_velocity(step, state));
  if (end_weight_ * dissipation_ < -thresholds_.max_created * size) {
    throw Error(ErrorKind::not_converged,
                fmt::format("contact nodes have more than one equilibrium position at the start of the step, and would "
                            "move to one of higher energy (by {:.2g} of the energy)",
                            -end_weight_ * dissipation_ / size));
  }
  if (is_done && corrects_velocity_ && energy_defect_size_ > thresholds_.max_corrected * size && !snap_logged_) {
    snap_logged_ = true;
    log::info(
        fmt::format("step {}: contact nodes snap to another equilibrium position; velocities compensate for the {:.2g} "
                    "of the energy that this releases or absorbs (reported once)",
                    state.step + 1, energy_defect_size_ / size));
  }
  if (is_done || energy_defect_size_ <= part_ * thresholds_.max_defect * size) return true;
  throw Error(ErrorKind::not_converged,
              fmt::format("no force at the middle of the step does the work of the elastic energy: {:.2g} of the "
                          "energy is missing, as strains change too much in one step",
                          energy_defect_size_ / size));
}

/// Corrects the velocities at the end such that they balance the energy if no σ does.
bool FiniteStrainStep::correct_velocity(double step, const State& state) {
  inertial_increment_ = middle_ - base_;
  end_velocity_ = state.velocity + (4.0 / step) * inertial_increment_;
  corrects_velocity_ = velocity_correction_->find(end_velocity_, end_, -energy_defect_);
  log::debug(fmt::format("velocities at the end are {}corrected", corrects_velocity_ ? "" : "not "));
  return corrects_velocity_;
}

}  // namespace ricochet
