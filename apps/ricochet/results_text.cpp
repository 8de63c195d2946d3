#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "ricochet/base/text.hpp"
#include "ricochet/simulation/impact/restitution.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"
#include "ricochet/simulation/monitor/stress_raisers.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

/// Returns the radius of gyration.
double radius_of(const BodyDescription& body) {
  return std::sqrt(body.rigid.inertia.diagonal().maxCoeff() / body.rigid.mass);
}

/// Returns a position of the mesh in its reference configuration.
std::string position_text(const std::vector<double>& point, const RunSummary& summary) {
  double size = 0.0;
  for (const BodyDescription& body : summary.bodies) size = std::max(size, body.rigid.centre.norm() + radius_of(body));
  return vector_text(Eigen::Map<const Vector>(point.data(), Index(point.size())), size, 5);
}

/// Returns a spin; in the plane it is a single number. Components smaller than `least` are 0.
std::string spin_text(const Eigen::Vector3d& spin, int dimension, double least) {
  const auto shown = [&](Index k) { return std::abs(spin[k]) > least ? spin[k] : 0.0; };
  if (dimension == 2) return fmt::format("{:.4g}", shown(2));
  return vector_text(Eigen::Vector3d(shown(0), shown(1), shown(2)), 0.0, 5);
}

/// Rounding of a spin, relative to the speed of the body and to the larger spin: a spin that moves the edge of the body
/// more slowly counts as zero.
constexpr double rounding_of_spin = 1e-6;

/// Returns "" if the body does not spin.
std::string spins_text(int body, const RigidMotionState& before, const RigidMotionState& after,
                       const RunSummary& summary) {
  const double largest = std::max(before.spin.norm(), after.spin.norm());
  const double speed = std::max(before.velocity.norm(), after.velocity.norm());
  const double radius = radius_of(summary.bodies[std::size_t(body)]);
  if (!(largest * radius > rounding_of_spin * speed)) return "";
  const double least = rounding_of_spin * std::max(largest, speed / radius);
  return fmt::format("{} before and {} after", spin_text(before.spin, summary.dimension, least),
                     spin_text(after.spin, summary.dimension, least));
}

std::string body_text(int number, const RunSummary& summary) {
  const std::string& name = summary.bodies[std::size_t(number)].name;
  return name.empty() ? fmt::format("body {}", number) : name;
}

/// Returns the name of the other body; a rigid body that moves freely has the name of its obstacle, in quotes.
std::string other_body_text(const Impact& impact, const RunSummary& summary) {
  std::string name = body_text(impact.other->number, summary);
  const bool is_obstacle = std::ranges::any_of(summary.contacts, [&](const ContactDescription& contact) {
    return contact.obstacle_moves_freely && contact.opponent == name;
  });
  return is_obstacle ? fmt::format("\"{}\"", name) : name;
}

std::string spins_text(const Impact& impact, const RunSummary& summary) {
  if (!impact.ended) return "";
  const std::string own = spins_text(impact.body, impact.before, impact.after, summary);
  if (!impact.other) return own.empty() ? "" : ", spin " + own;
  const std::string others = spins_text(impact.other->number, impact.other->before, impact.other->after, summary);
  std::string text;
  if (!own.empty()) text += fmt::format(", spin of {} {}", body_text(impact.body, summary), own);
  if (!others.empty()) text += fmt::format(", spin of {} {}", other_body_text(impact, summary), others);
  return text;
}

/// Returns bodies "one" and "two".
std::string bodies_text(const Impact& impact, const RunSummary& summary) {
  constexpr std::string_view prefix = "body ";
  const std::string one = body_text(impact.body, summary), two = other_body_text(impact, summary);
  const auto is_simple = [&](const std::string& name) {
    return name.starts_with(prefix) && name.find(" and ") == std::string::npos;
  };
  if (!is_simple(one) || !is_simple(two)) return fmt::format("{} on {}", one, two);
  return fmt::format("bodies {} and {}", one.substr(prefix.size()), two.substr(prefix.size()));
}

/// Returns "bodies "one" and "two" ", "body "left" on "floor" ", or only the obstacle if there is a single body.
std::string parties_text(const Impact& impact, const RunSummary& summary) {
  if (impact.other) return bodies_text(impact, summary) + " ";
  const std::string on = fmt::format("on \"{}\" ", impact.obstacle);
  return summary.bodies.size() > 1 ? body_text(impact.body, summary) + " " + on : on;
}

/// Returns the impulse of the normal contact forces, and the total impulse if friction makes it differ.
std::string impulse_text(const Impact& impact) {
  const std::string normal = fmt::format("{:.4g}", impact.normal_impulse.norm());
  const std::string total = fmt::format("{:.4g}", impact.impulse.norm());
  return "normal impulse " + normal + (total == normal ? "" : " (with friction " + total + ")");
}

/// Returns how much of the mesh took part in the impact.
std::string resolution_text(const Impact& impact) {
  if (impact.contact_points == 0) return "";
  const std::string points = fmt::format(", at most {} of {} at once", impact.contact_points,
                                         counted(impact.all_contact_points, "contact point"));
  if (!impact.is_coarse()) return points;
  return points + ": the contact zone is too coarse for a reliable largest force and duration; refine the mesh there";
}

/// Returns, for a run in which cells rotate too far, whether they had done so when this impact ended.
std::string rotation_text(std::size_t impact, const RunSummary& summary) {
  const RotationReport& rotation = summary.rotation;
  if (!std::isfinite(rotation.time_beyond) || impact >= rotation.until_impact_end.size()) return "";
  return fmt::format(", cells rotated by up to {:.3g} rad until {}{}", rotation.until_impact_end[impact],
                     summary.impacts[impact].ended ? "its end" : "now",
                     rotation.holds_in_impact(impact) ? "" : " (BEYOND SMALL STRAIN)");
}

/// Returns a note if the energy error of the method is large compared with the loss that the restitution implies.
std::string restitution_error_text(const Impact& impact) {
  const RestitutionError error = restitution_error(impact);
  if (!error.is_large) return "";
  return fmt::format(" (inexact: of the energy of the approach, the method {} {}, and {} {} {})",
                     error.by_method < 0.0 ? "lost" : "created", percent(std::abs(error.by_method)),
                     impact.other ? "the bodies" : "the body", error.by_impact < 0.0 ? "gained" : "lost",
                     percent(std::abs(error.by_impact)));
}

/// Returns a note if the linear law has changed the restitution through the rotation of a body.
std::string rotational_text(const Impact& impact) {
  if (!is_distorted_by_rotation(impact)) return "";
  const double error = restitution_excess(impact);
  return fmt::format(
      " (BEYOND SMALL STRAIN: too {} by about {:.2g}, because a rotating body grows under the linear law)",
      error > 0.0 ? "large" : "small", std::abs(error));
}

/// Whether the contact acts across the axis of an axisymmetric body: its force cancels over the ring, so that impulses
/// and largest force, which are those along the axis, are zero up to rounding.
bool is_radial(const Impact& impact, const RunSummary& summary) {
  constexpr double rounding = 1e-9;
  const auto plane = summary.parameters.find("mesh.plane");
  if (plane == summary.parameters.end() || plane->second != "axisymmetric" || impact.contact_points == 0) return false;
  double radial = 0.0;
  for (std::size_t i = 0; i < summary.columns.size() && i < summary.digests.size(); ++i) {
    const std::string& column = summary.columns[i];
    if (column != "contact_force_x" && !(column.starts_with("pair_force.") && column.ends_with("_x"))) continue;
    radial = std::max({radial, std::abs(summary.digests[i].minimum), std::abs(summary.digests[i].maximum)});
  }
  return impact.largest_force <= rounding * radial;
}

/// Returns the restitution, the impulse and the forces of an impact.
std::string collision_text(const Impact& impact) {
  std::string text;
  if (const auto restitution = impact.restitution()) {
    const std::string doubt = restitution_doubt(impact);
    text = fmt::format(", restitution {:.4g}{}{}{}", *restitution, doubt.empty() ? "" : " (" + doubt + ")",
                       restitution_error_text(impact), rotational_text(impact));
  } else if (impact.ended) {
    text = fmt::format(", no restitution ({})", why_no_restitution(impact));
  }
  return text + fmt::format(", {}, largest force {:.4g} at {:.6g} (mean {:.4g})", impulse_text(impact),
                            impact.largest_force, impact.largest_force_time, impact.mean_force());
}

std::string impact_text(std::size_t number, const RunSummary& summary) {
  const Impact& impact = summary.impacts[number];
  std::string text = parties_text(impact, summary);
  if (!impact.first_position.empty())
    text += fmt::format("first at {} ", position_text(impact.first_position, summary));
  text += fmt::format("from t = {:.6g}", impact.begin);
  if (impact.from_start) text += " (the start)";
  if (impact.ended) {
    text += fmt::format(" to {:.6g} (duration {:.4g})", impact.end, impact.end - impact.begin);
  } else {
    text += ", not ended";
  }
  text += is_radial(impact, summary)
              ? ", radial contact: its force has no resultant along the axis, hence no impulse; a "
                "[[probe]] of the contact shows the force"
              : collision_text(impact);
  return text + spins_text(impact, summary) + rotation_text(number, summary) + resolution_text(impact);
}

void print_no_contact(const RunSummary& summary) {
  if (summary.contacts.empty() || summary.steps == 0) return;
  if (!summary.impacts.empty() || summary.impacts_left_out > 0) return;
  // As if a body touches itself.
  if (summary.digest("active_contacts").maximum > 0.0) {
    fmt::print("  contact forces acted only within one body, which is not an impact\n");
    return;
  }
  fmt::print("  no contact: no contact force {}\n",
             summary.status == "done" ? "acted in this run" : "has acted in this run so far");
}

}  // namespace

void print_impacts(const RunSummary& summary, std::size_t most) {
  print_no_contact(summary);
  const std::size_t count = summary.impacts.size();
  const std::size_t shown = most == 0 ? count : std::min(most, count);
  for (std::size_t i = 0; i < shown; ++i) fmt::print("  impact {}: {}\n", i + 1, impact_text(i, summary));
  const auto others = long(count - shown) + summary.impacts_left_out;
  if (others > 0) fmt::print("  {}{}\n", counted(others, "more impact"), most == 0 ? "" : ", see summary.json");
}

void print_peak_stress(const RunSummary& summary) {
  if (!summary.peak_stress) return;
  const PeakStressDescription& d = *summary.peak_stress;
  const bool all = d.peak.evaluations >= d.peak.states;
  fmt::print(
      "  largest von Mises stress {}{:.6g} at t = {:.6g}, in \"{}\" at {} (mean of a cell; {})\n", all ? "" : "≥ ",
      d.peak.von_mises, d.peak.time, d.material, position_text(d.position, summary),
      all ? "evaluated in every step" : fmt::format("evaluated in {} of {} steps", d.peak.evaluations, d.peak.states));
  if (d.peak.raised_by != StressRaiser::none)
    fmt::print("    it grows with refinement: it sits on {}\n", name_of(d.peak.raised_by));
}

namespace {

/// Nodes of one [[probe]]: the entries from `first` up to, but excluding, `last`.
struct ProbeNodes {
  std::string name;
  std::size_t first, last;
  bool is_segment;
};

/// Returns the probes. The name of a probe has no dot; the nodes of a segment are called NAME.0, NAME.1 and so on.
std::vector<ProbeNodes> probes_of(const RunSummary& summary) {
  std::vector<ProbeNodes> result;
  for (std::size_t i = 0; i < summary.probes.size(); ++i) {
    const std::string& full = summary.probes[i].probe.name;
    const std::string name = full.substr(0, full.find('.'));
    const bool is_segment = name.size() < full.size();
    if (is_segment && !result.empty() && result.back().is_segment && result.back().name == name) {
      result.back().last = i + 1;
    } else {
      result.push_back({name, i, i + 1, is_segment});
    }
  }
  return result;
}

std::string probe_position_text(const RunSummary& summary, std::size_t probe) {
  const std::vector<double>& at = summary.probes[probe].position;
  return vector_text(Eigen::Map<const Vector>(at.data(), Index(at.size())));
}

/// Returns true if the force of a probe has a digest; probes with rows of their own have none.
bool has_force(const RunSummary& summary, const Probe& probe) {
  return probe.contact_node >= 0 &&
         std::ranges::find(summary.columns, probe.name + ".reaction_normal") != summary.columns.end();
}

}  // namespace

void print_probes(const RunSummary& summary) {
  for (const ProbeNodes& probe : probes_of(summary)) {
    if (probe.is_segment) {
      fmt::print("  probe \"{}\": {} from {} to {}", probe.name, counted(probe.last - probe.first, "node"),
                 probe_position_text(summary, probe.first), probe_position_text(summary, probe.last - 1));
    } else {
      fmt::print("  probe \"{}\": its node is {:.3g} from the requested position", probe.name,
                 summary.probes[probe.first].probe.distance);
    }
    ColumnDigest hardest;
    bool any = false;
    for (std::size_t i = probe.first; i < probe.last; ++i) {
      if (!has_force(summary, summary.probes[i].probe)) continue;
      const ColumnDigest force = summary.digest(summary.probes[i].probe.name + ".reaction_normal");
      if (!any || force.maximum > hardest.maximum) hardest = force;
      any = true;
    }
    if (any) {
      fmt::print(", largest contact force {}{:.6g}", probe.is_segment ? "on a node " : "", hardest.maximum);
      if (!probe.is_segment) {
        const bool skips = summary.history_every > 1;
        fmt::print(", total variation {}{:.4g}", skips ? "≥ " : "", hardest.total_variation);
        if (skips) fmt::print(" (from one row every {} steps)", summary.history_every);
      }
    }
    fmt::print("\n");
  }
  for (const auto& [name, sums] : summary.probe_sums) fmt::print("  probe \"{}\": {}\n", name, sums);
}

std::string found_text(const ExpectationResult& expectation) {
  return expectation.note.empty() ? fmt::format("found {:.9g}", expectation.value)
                                  : fmt::format("found no value: {}", expectation.note);
}

void print_expectations(const std::vector<ExpectationResult>& expectations) {
  if (expectations.empty()) return;
  const auto met = std::ranges::count_if(expectations, [](const auto& e) { return e.checked && e.holds; });
  const auto left_out = std::ranges::count_if(expectations, [](const auto& e) { return !e.checked; });
  const auto checked = long(expectations.size()) - left_out;
  const std::string others = fmt::format("{} not apply to this run (see summary.json for the reason)",
                                         left_out == 1 ? "1 does" : fmt::format("{} do", left_out));
  if (checked == 0) {
    fmt::print("  expectations: {}\n", others);
  } else {
    fmt::print("  {} of {}{}\n", met, counted(checked, "expectation") + (checked == 1 ? " holds" : " hold"),
               left_out > 0 ? "; " + others : "");
  }
  for (const ExpectationResult& e : expectations) {
    if (!e.checked || e.holds) continue;
    fmt::print("  DOES NOT HOLD: {} (expected {}, {})\n", e.label(), e.expected, found_text(e));
    if (!e.published.empty()) fmt::print("    published: {}\n", e.published);
  }
}

}  // namespace ricochet::program
