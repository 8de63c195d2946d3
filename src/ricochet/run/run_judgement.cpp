#include "ricochet/run/run_judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/log.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/run/rotation_watch.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"

namespace ricochet {

/// Rotation, in rad, above which the run reports at its end how large the error has become; the error grows with the
/// square.
constexpr double large_rotation = 2.0 * rotation_limit;
/// Tolerance of Newton's method above which it may cause large corrections of velocities by itself (measured,
/// docs/finite-strain-proofs.md).
constexpr double loose_tolerance = 1e-6;
/// Equivalent strain above which small strain does not hold.
constexpr double strain_limit = 0.1;

bool is_rounding_of_energy(double energy, const SemidiscreteProblem& problem, const State& state) {
  // Energies are computed from displacements without their rigid part (LinearElasticity), and their rounding is that of
  // this part.
  const InternalForce& force = *problem.internal_force;
  double terms = 0.0;
  if (force.is_linear()) {
    terms = force.energy_terms(state.displacement);
  } else {
    // Strains are differences of rounded positions, so that strains of that size are rounding.
    constexpr double rounding = 1e-14;
    const Vector magnitude = rounding * problem.nodes.reshaped().cwiseAbs();
    terms = magnitude.dot(force.tangent().cwiseAbs() * magnitude);
  }
  return energy <= 1e-14 * problem.ranks->sum(terms);
}

/// Warns of a loss of energy that no real body has, in an impact whose step is too long for its waves. If nothing
/// rebounds, as in sliding or pressing, forces do far more work than is ever stored, and the loss is compared with that
/// work.
void judge_loss(const RunSummary& summary, const Scheme& scheme, const SemidiscreteProblem& problem,
                const State& state) {
  constexpr double most = 0.05;
  const double loss = summary.method_energy.lost, energy = summary.energy_scale(), work = summary.work_scale();
  if (!(loss > most) || is_rounding_of_energy(energy, problem, state)) return;
  const bool rebounds =
      std::ranges::any_of(summary.impacts, [](const Impact& impact) { return impact.restitution().has_value(); });
  if (!rebounds) {
    if (loss * energy > most * work) {
      log::warning(
          fmt::format("contact forces and the scheme itself have removed {:.2g} % of the largest energy (contact_work "
                      "and numerical_dissipation of the history), which a real body keeps as waves: vibrations of this "
                      "run are too weak by this amount",
                      100.0 * loss));
    }
    return;
  }
  const std::string setting = scheme.traits_for(problem).less_dissipative_setting;
  log::warning(
      fmt::format("contact forces and the scheme itself have removed {:.2g} % of the largest energy (contact_work and "
                  "numerical_dissipation of the history), which a real body keeps as waves: rebounds lack this much "
                  "energy; a smaller time.step and smaller cells lose less{}",
                  100.0 * loss, setting.empty() ? "" : ", and so does " + setting));
}

void judge_energy(const RunSummary& summary, const Scheme& scheme, const SemidiscreteProblem& problem,
                  const State& state) {
  const double scale = summary.energy_scale();
  const bool contact_creates = summary.method_energy.created > 0.01;
  const bool friction_creates = summary.digest("friction_work").maximum > 0.01 * scale;
  const double rotation = summary.digest("max_rotation").maximum;
  const bool is_small = std::isfinite(summary.rotation.limit);  // small strain
  // Rotations in free flight after the impacts do not affect their results.
  const bool rotates = is_small && rotation > large_rotation && !summary.cells_turn_little_in_impacts();
  if (summary.adaptive && summary.adaptive->counts.tolerated > 0) {
    const StepCounts& counts = summary.adaptive->counts;
    log::warning(
        fmt::format("{} of {} have an error above time.tolerance, up to {:.2g} times it: set a smaller time.smallest "
                    "or a larger time.tolerance",
                    counts.tolerated, counted(summary.steps, "step"), counts.largest_error));
  }
  judge_loss(summary, scheme, problem, state);
  if (!(contact_creates || friction_creates || rotates) || is_rounding_of_energy(scale, problem, state)) return;
  if (contact_creates) {
    const bool helps = scheme.traits().suits_singular_mass && problem.has_singular_mass();
    log::warning(fmt::format(
        "{} created energy, {:.2g} times the largest energy (contact_work less numerical_dissipation "
        "of the history); {} scheme \"reduced-kane\" with mass \"equivalent\", which creates none",
        problem.contact.size() > 0 ? "contact forces have" : "the time scheme has", summary.method_energy.created,
        helps ? "use a smaller time.step, below the time in which a wave crosses a cell, or"
              : "it comes from the time scheme: use"));
  }
  if (friction_creates) {
    const char* const remedy = problem.has_singular_mass() ? "use a smaller time.step, or"
                               : scheme.traits().suits_singular_mass
                                   ? "with inertia on contact nodes, smaller steps alone do not help: use mass "
                                     "\"equivalent\" with a smaller time.step, or"
                                   : "use";
    log::warning(
        fmt::format("friction has created energy: friction_work reaches {:.2g} times the largest energy; it comes from "
                    "the weights that {} assigns to the forces at the two ends of a step: {} scheme \"reduced-kane\" "
                    "with mass \"equivalent\", whose friction creates none",
                    summary.digest("friction_work").maximum / scale, summary.scheme, remedy));
  }
  if (rotates) {
    log::warning(
        fmt::format("cells rotate by up to {:.3g} rad, which under small strain causes {}: energies, forces and "
                    "rebounds of this run are not those of a real body. Use a law in its [[material]] that holds for "
                    "any rotation (law = \"neo-hookean\"); a stiffer body, a slower impact or less spin keeps "
                    "rotations below {} rad; also check the units",
                    rotation, spurious_strain(rotation), rotation_limit));
  }
}

void judge_velocity_corrections(const RunSummary& summary, double newton_tolerance, const SemidiscreteProblem& problem,
                                const State& state) {
  if (!summary.velocity_corrections || summary.velocity_corrections->steps == 0) return;
  if (is_rounding_of_energy(summary.energy_scale(), problem, state)) return;
  const VelocityCorrections& found = *summary.velocity_corrections;
  log::warning(fmt::format(
      "in {} of {}, from t = {:.6g} on, corrections of velocities, which close the balance of energy, changed more "
      "than {:g} % of kinetic and elastic energy, up to {:.2g} % at t = {:.6g} (velocity_correction of the history), "
      "and vibrations carry an error of this size; {}",
      found.steps, counted(summary.steps, "step"), found.first_time, 100.0 * VelocityCorrections::noticeable,
      100.0 * found.largest, found.time,
      newton_tolerance > loose_tolerance
          ? "set solver.newton_tolerance = 1e-6 or less, and if that does not suffice, use a smaller time.step"
          : "strains change too much in a step: use a smaller time.step"));
}

void judge_unsettled(const RunSummary& summary) {
  for (const UnsettledContact& contact : summary.unsettled) {
    if (contact.share <= UnsettledContact::doubtful) continue;
    const ContactDescription& pair = summary.contacts[std::size_t(contact.contact)];
    log::warning(fmt::format(
        "the force of the contact of {} is in doubt: up to {:.3g} % of it is at stake where frozen steps have left {} "
        "of up to {:.3g}, in {} from t = {:.6g} on",
        pair_names(pair.group, pair.opponent), 100.0 * contact.share, contact.gap < 0.0 ? "overlaps" : "gaps",
        std::abs(contact.gap), counted(contact.steps, "step"), contact.first_time));
  }
}

void judge_sliding(const RunSummary& summary, const SemidiscreteProblem& problem, const Body& body) {
  constexpr long many = 30;
  const long impacts = long(summary.impacts.size()) + summary.impacts_left_out;
  if (impacts <= many || !problem.contact.has_friction() || problem.has_damping()) return;
  const std::vector<double> times = cell_crossing_times(body);
  log::warning(
      fmt::format("contact was made {} times: a body that slides without damping flutters, and contact forces and "
                  "stresses are those of its vibrations. If it should slide, set damping = {{ stiffness = "
                  "{:.2g} }} in its [[material]]: the time in which a wave crosses a cell",
                  impacts, times[times.size() / 2]));
}

void judge_strain(const RunSummary& summary, const Body& body) {
  if (!summary.peak_stress) return;
  const auto material = std::ranges::find_if(
      body.materials, [&](const Material& candidate) { return candidate.name == summary.peak_stress->material; });
  if (material == body.materials.end()) return;
  const double strain = summary.peak_stress->peak.von_mises / (3.0 * material->mu());
  if (!(strain > strain_limit) || !material->law->is_linear()) return;
  log::warning(
      fmt::format("at t = {:.6g} the largest von Mises stress corresponds to an equivalent strain of {:.2g} %: small "
                  "strain neglects terms of that relative size and does not hold there; stresses and forces are wrong "
                  "by as much. law = \"neo-hookean\" holds for any strain; a stiffer body or a slower impact keeps the "
                  "strain below {:g} %; also check the units",
                  summary.peak_stress->peak.time, 100.0 * strain, 100.0 * strain_limit));
}

void judge_rotation_growth(const RunSummary& summary) {
  std::size_t worst = summary.impacts.size();
  double largest = restitution_excess_limit;
  for (std::size_t i = 0; i < summary.impacts.size(); ++i) {
    const double error = std::abs(restitution_excess(summary.impacts[i]));
    // A warning at the time when cells rotated too far has covered the others.
    if (!(error > largest) || !summary.rotation.holds_in_impact(i)) continue;
    worst = i;
    largest = error;
  }
  if (worst == summary.impacts.size()) return;
  const double error = restitution_excess(summary.impacts[worst]);
  log::warning(fmt::format(
      "the restitution of impact {} is too {} by about {:.2g}, and its force and duration are wrong by about a third "
      "of that fraction: under the linear law a rotating body grows, here at a speed of {:.2g} towards the contact, as "
      "if an obstacle moved; use law = \"neo-hookean\" in [[material]], which holds for any rotation",
      worst + 1, error > 0.0 ? "large" : "small", largest, summary.impacts[worst].rotation_growth));
}

}  // namespace ricochet
