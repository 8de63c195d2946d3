#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/text.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

std::string law_text(const ContactDescription& c) {
  if (c.friction == 0.0 && c.friction_bound == 0.0) return "no friction";
  if (c.friction_bound == 0.0) return fmt::format("friction {:g}", c.friction);
  if (c.friction == 0.0) return fmt::format("friction bound {:g}", c.friction_bound);
  return fmt::format("friction {:g} up to {:g}", c.friction, c.friction_bound);
}

std::string motion_text(const ContactDescription& c) {
  std::string text;
  if (!c.obstacle_velocity.empty())
    text += fmt::format(", {} at ({:g})", c.obstacle_moves_freely ? "starting" : "moving",
                        fmt::join(c.obstacle_velocity, ", "));
  if (c.obstacle_rotation_rate != 0.0) text += fmt::format(", rotating at {:g}", c.obstacle_rotation_rate);
  return text;
}

}  // namespace

std::string facing_text(const PairingDescription& facing) {
  std::string gaps = "the gaps are closed";
  if (facing.smallest_gap > facing.largest_gap) {
    gaps = "none of which faces the other side at the start";
  } else if (facing.smallest_gap != 0.0 || facing.largest_gap != 0.0)
    gaps = fmt::format("gaps from {:.4g} to {:.4g}", facing.smallest_gap, facing.largest_gap);
  return fmt::format("\"{}\" carries the multipliers{}; {} on {} of its area, {}", facing.multipliers_on,
                     facing.reason.empty() ? ", as the case specifies" : ": " + facing.reason,
                     counted(facing.points, "contact point"), percent(facing.covered), gaps);
}

void print_contacts(const std::vector<ContactDescription>& contacts) {
  std::string last_group;
  for (const ContactDescription& c : contacts) {
    if (!c.all_pairs_group.empty() && c.all_pairs_group == last_group) continue;
    last_group = c.all_pairs_group;
    if (c.tied) {
      fmt::print("  \"{}\" tied to \"{}\"\n", c.group, c.opponent);
      continue;
    }
    const auto pairs = std::ranges::count_if(
        contacts, [&](const ContactDescription& other) { return other.all_pairs_group == c.all_pairs_group; });
    const std::string what =
        c.all_pairs_group.empty()
            ? fmt::format("\"{}\" {} \"{}\"", c.group, c.between_bodies ? "against" : "with", c.opponent)
        : c.opponent.empty()
            ? fmt::format("every body of \"{}\" against every other", c.all_pairs_group)
            : fmt::format("every body of \"{}\" against every other, {}", c.all_pairs_group, counted(pairs, "pair"));
    fmt::print("  contact of {}{}: {}, {} multipliers\n", what, motion_text(c), law_text(c), c.multipliers);
    if (c.facing && c.all_pairs_group.empty()) fmt::print("    {}\n", facing_text(*c.facing));
  }
}

void print_friction(const RunSummary& summary) {
  const std::vector<ContactDescription>& contacts = summary.contacts;
  const bool has_friction = std::ranges::any_of(
      contacts, [](const ContactDescription& c) { return c.friction > 0.0 || c.friction_bound > 0.0; });
  const bool moves = std::ranges::any_of(contacts, [](const ContactDescription& c) {
    return !c.obstacle_moves_freely && (!c.obstacle_velocity.empty() || c.obstacle_rotation_rate != 0.0);
  });
  const double obstacle_work = summary.digest("obstacle_work").last;
  if (has_friction) {
    fmt::print("  friction work {:.6g}, obstacle work {:.6g}; at most {} stick and {} slip at a time\n",
               summary.digest("friction_work").last, obstacle_work,
               counted(std::lround(summary.digest("sticking").maximum), "point"),
               std::lround(summary.digest("slipping").maximum));
  } else if (moves) {
    fmt::print("  obstacle work {:.6g}\n", obstacle_work);
  }
}

}  // namespace ricochet::program
