#include "penetration_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ricochet/fem/rotation_gauge.hpp"

namespace ricochet::program {

namespace {

std::string found_text(const UnwatchedPenetration& p) {
  const std::string what = p.obstacle.empty() ? fmt::format("{} and {} overlap", p.bodies[0], p.bodies[1])
                                              : fmt::format("{} in \"{}\"", p.bodies[0], p.obstacle);
  return fmt::format("\n  PENETRATION WITHOUT CONTACT: {}, {:.3g} deep at t = {:.6g} at ({:.4g})", what, p.depth,
                     p.time, fmt::join(p.place, ", "));
}

/// Since when cells have turned too far. What comes after the last impact does not change what it came to.
std::string beyond_text(const RunSummary& s) {
  if (!s.rotation) return " (BEYOND SMALL STRAIN)";
  const std::string since = fmt::format("t = {:.6g} on", s.rotation->time_beyond);
  if (s.impacts.empty()) return fmt::format(" (BEYOND SMALL STRAIN from {})", since);
  if (s.small_strain_holds_in_impacts())
    return fmt::format(" (beyond small strain from {}, after the last impact had ended)", since);
  return fmt::format(" (BEYOND SMALL STRAIN from {}, before the last impact {})", since,
                     s.impacts.back().ended ? "ended" : "has ended");
}

}  // namespace

std::string deformation_text(const RunSummary& s) {
  const double rotation = s.digest("max_rotation").maximum;
  std::string text =
      fmt::format("  deepest interpenetration {:.3g}{}, largest rotation of a cell {:.3g} rad{}",
                  s.digest("max_penetration").maximum,
                  s.penetration.checked ? " of contact points" : " of contact points (no others were looked at)",
                  rotation, rotation > rotation_limit ? beyond_text(s) : "");
  for (const UnwatchedPenetration& found : s.penetration.found) text += found_text(found);
  for (const ContactBeyondRim& rim : s.penetration.rims)
    text += fmt::format("\n  the contact of \"{}\" with \"{}\" goes on beyond its group", rim.group, rim.obstacle);
  return text;
}

std::string deepest_penetration_text(const RunSummary& s) {
  return fmt::format("{}{:.3g}", s.penetration.checked ? "" : "≥ ", s.deepest_penetration());
}

}  // namespace ricochet::program
