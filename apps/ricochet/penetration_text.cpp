#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/fem/cell_rotations.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

std::string found_text(const UnwatchedPenetration& p) {
  const std::string what = p.is_self_penetration() ? p.bodies[0] + " in itself"
                           : p.obstacle.empty()    ? fmt::format("{} and {} overlap", p.bodies[0], p.bodies[1])
                                                   : fmt::format("{} in \"{}\"", p.bodies[0], p.obstacle);
  const std::string kind =
      p.passed_through    ? "PASSED THROUGH WITHIN ONE STEP"
      : p.contact.empty() ? "PENETRATION WITHOUT CONTACT"
                          : fmt::format("PENETRATION AT THE CONTACT of {}", pair_names(p.contact[0], p.contact[1]));
  return fmt::format("\n  {}: {}, {:.3g} deep at t = {:.6g} at ({:.4g})", kind, what, p.depth, p.time,
                     fmt::join(p.position, ", "));
}

/// Slip, relative to its limit, below which it counts as none.
constexpr double rounding_of_slip = 1e-6;

/// Describes the sliding of a contact that was pressed somewhere.
std::string sliding_text(const PairSliding& pair, const RunSummary& s) {
  if (!(pair.slip > rounding_of_slip * pair.limit)) return "";
  if (pair.contact < 0 || pair.contact >= int(s.contacts.size())) return "";
  const ContactDescription& contact = s.contacts[std::size_t(pair.contact)];
  std::string text = fmt::format("\n  \"{}\" and \"{}\" slid along each other by up to {:.3g} while in contact",
                                 contact.group, contact.opponent, pair.slip);
  if (pair.is_beyond()) {
    text += fmt::format(" (BEYOND SMALL SLIDING from t = {:.6g}: more than half of the smaller facet, {:.3g})",
                        pair.time_beyond, pair.limit);
  }
  return text;
}

std::string unsettled_text(const UnsettledContact& unsettled, const RunSummary& s) {
  if (unsettled.contact < 0 || unsettled.contact >= int(s.contacts.size())) return "";
  const ContactDescription& contact = s.contacts[std::size_t(unsettled.contact)];
  return fmt::format(
      "\n  {}: up to {:.3g} % of the force of {} is at stake at points where frozen steps have left {} (up to {:.3g}, "
      "from t = {:.6g} on)",
      unsettled.share > UnsettledContact::doubtful ? "FORCE IN DOUBT" : "frozen steps", 100.0 * unsettled.share,
      pair_names(contact.group, contact.opponent), unsettled.gap < 0.0 ? "an overlap" : "a gap",
      std::abs(unsettled.gap), unsettled.first_time);
}

/// Returns the time from which cells have rotated too far. Rotations after the last impact do not affect its results.
std::string beyond_text(const RunSummary& s) {
  const std::string since = fmt::format("t = {:.6g} on", s.rotation.time_beyond);
  if (s.impacts.empty()) return fmt::format(" (BEYOND SMALL STRAIN from {})", since);
  if (s.cells_turn_little_in_impacts())
    return fmt::format(" (beyond small strain from {}, after the last impact had ended)", since);
  return fmt::format(" (BEYOND SMALL STRAIN from {}, before the last impact {})", since,
                     s.impacts.back().ended ? "ended" : "has ended");
}

}  // namespace

std::string deformation_text(const RunSummary& s) {
  const double rotation = s.digest("max_rotation").maximum;
  std::string text =
      fmt::format("  deepest interpenetration {:.3g} of contact nodes, largest rotation of a cell {:.3g} rad{}",
                  s.digest("max_penetration").maximum, rotation, rotation > s.rotation.limit ? beyond_text(s) : "");
  for (const UnwatchedPenetration& found : s.penetration.found) text += found_text(found);
  for (const std::string& what : s.penetration.not_watched)
    text += fmt::format("\n  not checked for interpenetration: {}", what);
  for (const ContactBeyondRim& rim : s.penetration.rims)
    text += fmt::format("\n  the contact of \"{}\" with \"{}\" extends beyond its group", rim.group, rim.obstacle);
  for (const PairSliding& pair : s.sliding) text += sliding_text(pair, s);
  for (const UnsettledContact& contact : s.unsettled) text += unsettled_text(contact, s);
  return text;
}

std::string deepest_penetration_text(const RunSummary& s) {
  return fmt::format("{}{:.3g}", s.penetration.is_complete() ? "" : "≥ ", s.deepest_penetration());
}

}  // namespace ricochet::program
