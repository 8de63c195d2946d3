#include "outcome_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ricochet::program {

namespace {

std::string vector_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.5g}", text.empty() ? "" : ", ", value);
  return "(" + text + ")";
}

/// In the plane there is one number.
std::string spin_text(const Eigen::Vector3d& spin, int dimension) {
  return dimension == 2 ? fmt::format("{:.4g}", spin[2]) : vector_text({spin[0], spin[1], spin[2]});
}

/// That of the normal parts of the contact forces, and of all of them where friction makes another number of it.
std::string impulse_text(const Impact& impact) {
  const std::string normal = fmt::format("{:.4g}", impact.normal_impulse.norm());
  const std::string whole = fmt::format("{:.4g}", impact.impulse.norm());
  return "normal impulse " + normal + (whole == normal ? "" : " (with friction " + whole + ")");
}

std::string impact_text(const Impact& impact, const RunSummary& summary) {
  std::string text;
  if (summary.bodies.size() > 1) text += fmt::format("body {} ", impact.body);
  text += fmt::format("on \"{}\" from t = {:.6g}", impact.obstacle, impact.begin);
  if (impact.from_start) text += " (the start)";
  if (impact.ended) {
    text += fmt::format(" to {:.6g} (duration {:.4g})", impact.end, impact.end - impact.begin);
  } else {
    text += ", not ended";
  }
  if (const auto restitution = impact.restitution()) text += fmt::format(", restitution {:.4g}", *restitution);
  text += fmt::format(", {}, largest force {:.4g} at {:.6g}", impulse_text(impact), impact.largest_force,
                      impact.largest_force_time);
  const double before = impact.before.spin.norm(), after = impact.ended ? impact.after.spin.norm() : 0.0;
  // A body that does not spin shows rounding.
  const double speed = std::max(impact.before.velocity.norm(), impact.after.velocity.norm());
  const RigidBody& body = summary.bodies[static_cast<std::size_t>(impact.body)].rigid;
  const double radius = std::sqrt(body.inertia.diagonal().maxCoeff() / body.mass);
  if (impact.ended && std::max(before, after) * radius > 1e-6 * speed) {
    text += fmt::format(", spin {} before and {} after", spin_text(impact.before.spin, summary.dimension),
                        spin_text(impact.after.spin, summary.dimension));
  }
  return text;
}

void print_no_contact(const RunSummary& summary) {
  // Results of a version that told no impacts list no bodies: nothing is known of them.
  if (summary.contacts.empty() || summary.bodies.empty() || summary.steps == 0) return;
  if (!summary.impacts.empty() || summary.impacts_left_out > 0) return;
  fmt::print("  no contact: no contact force {}\n",
             summary.status == "done" ? "acted in this run" : "has acted in this run so far");
}

}  // namespace

void print_impacts(const RunSummary& summary, std::size_t most) {
  print_no_contact(summary);
  const std::size_t count = summary.impacts.size();
  const std::size_t shown = most == 0 ? count : std::min(most, count);
  for (std::size_t i = 0; i < shown; ++i)
    fmt::print("  impact {}: {}\n", i + 1, impact_text(summary.impacts[i], summary));
  const auto others = static_cast<long>(count - shown) + summary.impacts_left_out;
  if (others > 0) fmt::print("  {} more impacts{}\n", others, most == 0 ? "" : ", see summary.json");
}

void print_peak_stress(const RunSummary& summary) {
  if (!summary.peak_stress) return;
  const PeakStressDescription& d = *summary.peak_stress;
  fmt::print("  largest von Mises stress {:.6g} at t = {:.6g}, in \"{}\" at {} (mean of a cell; {})\n",
             d.peak.von_mises, d.peak.time, d.material, vector_text(d.place),
             d.peak.looks == d.peak.states ? "looked at in every step"
                                           : fmt::format("looked at in {} of {} steps", d.peak.looks, d.peak.states));
}

}  // namespace ricochet::program
