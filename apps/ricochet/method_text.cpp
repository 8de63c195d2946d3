#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/text.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

/// Rounding over many steps, relative to the largest energy.
constexpr double rounding_of_energies = 1e-8;
/// Ratio to the larger of two numbers below which the smaller one is not reported.
constexpr double beside = 0.01;

std::string energy_text(const RunSummary& summary) {
  const double lost = summary.method_energy.lost, created = summary.method_energy.created;
  const double most = std::max(lost, created);
  if (!(most > rounding_of_energies))
    return fmt::format("the method conserved the energy to within {:.1e} of the largest", most);
  const bool both = std::min(lost, created) > beside * most;
  // Omitted if it equals the number just reported.
  const double at_end = summary.method_energy.at_end;
  const bool gave_back = std::abs(std::abs(at_end) - most) > beside * most;
  const char* const up_to = both || gave_back ? "up to " : "";
  std::string text = "the method";
  if (both || created > lost) text += fmt::format(" created {}{}", up_to, percent(created));
  if (both) text += " and";
  if (both || lost >= created) text += fmt::format(" lost {}{}", up_to, percent(lost));
  text += " of the largest energy";
  if (gave_back) text += fmt::format(", {}{} at the end", at_end > 0.0 ? "+" : "", percent(at_end));
  return text + " (contact work and numerical dissipation)";
}

}  // namespace

std::string method_energy_mark(const RunSummary& summary) {
  const double lost = summary.method_energy.lost, created = summary.method_energy.created;
  if (!(std::max(lost, created) > rounding_of_energies)) return "0";
  return created > lost ? "+" + percent(created) : "-" + percent(lost);
}

std::string reactions_text(const RunSummary& summary) {
  if (!summary.reactions) return "";
  const ActingReactions& acting = *summary.reactions;
  if (acting.kind == "end") return "those at the end of the step";
  if (acting.mean_steps + acting.end_steps == 0) return "the mean over the step (no contact occurred)";
  std::string text = "the mean over the step";
  if (acting.mean_steps > 0) {
    const std::string least = fmt::format("{:.2g}", acting.least_weight);
    const std::string largest = fmt::format("{:.2g}", acting.largest_weight);
    if (largest != "0")
      text += fmt::format(", in which those at its end have the weight {}",
                          least == largest ? least : least + " to " + largest);
  }
  if (acting.end_steps > 0)
    text += fmt::format("; those at the end of the step in {} of {} with contact, for which no mean was found",
                        acting.end_steps, counted(acting.mean_steps + acting.end_steps, "step"));
  return text;
}

void print_method(const RunSummary& summary) {
  if (summary.steps == 0) return;
  const std::string reactions = reactions_text(summary);
  fmt::print("  {}{}\n", energy_text(summary), reactions.empty() ? "" : "; reactions: " + reactions);
  const double heat = summary.digest("viscous_dissipation").last, energy = summary.energy_scale();
  if (heat > 0.0 && energy > 0.0)
    fmt::print("  relaxation dissipated {} of the largest energy as heat\n", percent(heat / energy));
  if (summary.velocity_corrections && summary.velocity_corrections->steps > 0) {
    const VelocityCorrections& found = *summary.velocity_corrections;
    fmt::print("  LARGE CORRECTIONS OF VELOCITIES in {} of {}: up to {} of the energy, at t = {:.6g}\n", found.steps,
               counted(summary.steps, "step"), percent(found.largest), found.time);
  }
  const double iterations = summary.digest("newton_rounds").maximum;
  if (iterations > 0.0) fmt::print("  Newton's method required up to {:.0f} iterations in a step\n", iterations);
}

std::string steps_text(const RunSummary& summary) {
  if (!summary.adaptive) return fmt::format("{} of {:g}", counted(summary.steps, "step"), summary.step);
  const StepCounts& counts = summary.adaptive->counts;
  std::string text = fmt::format("{} of {:.4g} to {:.4g} ({} refused", counted(summary.steps, "step"), counts.shortest,
                                 counts.longest, counts.refused);
  if (counts.unsolved > 0) text += fmt::format(", {} not solved", counts.unsolved);
  if (counts.tolerated > 0) text += fmt::format(", {} above the tolerance", counts.tolerated);
  return text + ")";
}

}  // namespace ricochet::program
