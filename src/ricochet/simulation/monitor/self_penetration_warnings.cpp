#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/mesh/derived_groups.hpp"
#include "ricochet/simulation/monitor/penetration_phrases.hpp"
#include "ricochet/simulation/monitor/penetration_watch.hpp"

/// @file Warnings of self-penetration.
namespace ricochet {

namespace words = penetration_phrases;

void PenetrationWatch::warn_of_self_penetration() {
  const std::vector<SelfPenetration>& bodies = self_watch_.bodies();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (self_penetration_warned_[i] == 0 && bodies[i].deepest.found()) {
      self_penetration_warned_[i] = 1;
      warn_of(bodies[i]);
    }
    if (self_contact_warned_[i] == 0 && bodies[i].at_contact.found()) {
      self_contact_warned_[i] = 1;
      warn_at_contact(bodies[i]);
    }
  }
}

void PenetrationWatch::warn_of(const SelfPenetration& found) const {
  const UnwatchedPenetration p = self_penetration(found);
  const auto named = [](const std::vector<std::string>& groups) {
    return groups.empty() ? std::string("outside all boundary groups of the mesh")
                          : fmt::format("of group{} {}", groups.size() == 1 ? "" : "s", join_names(groups));
  };
  log::warning(
      fmt::format("{} {} has gone through itself by {} at {}: the boundary {} has passed through the boundary {}, and "
                  "no [[contact]] keeps them apart; {}. {}",
                  words::when(p.time), p.bodies[0], words::depth_text(p), words::coordinates(p.position),
                  named(p.groups), named(p.through_groups), words::see_summary, contact_with_itself(found.body, p)));
}

/// Names the smallest group on this body alone that contains both facets, or one group for each.
std::string PenetrationWatch::contact_with_itself(int body, const UnwatchedPenetration& found) const {
  std::map<std::string, std::size_t> sizes;
  for (const BoundaryGroup& group : boundary_groups_) {
    const bool is_own = std::ranges::all_of(
        group.nodes, [&](Index node) { return bodies_.connected.of_node[std::size_t(node)] == body; });
    if (is_own && !group.name.starts_with('[')) sizes[group.name] = group.nodes.size();  // no union of groups
  }
  const auto smallest = [&](const std::vector<std::string>& names, const std::vector<std::string>& among) {
    std::string best;
    for (const std::string& name : names) {
      const bool may = sizes.contains(name) && std::ranges::find(among, name) != among.end();
      if (may && (best.empty() || sizes[name] < sizes[best])) best = name;
    }
    return best;
  };
  std::string group = smallest(found.groups, found.through_groups), against = group;
  if (group.empty()) {
    group = smallest(found.groups, found.groups);
    against = smallest(found.through_groups, found.through_groups);
  }
  if (bodies_.connected.count == 1 && (group.empty() || against.empty())) group = against = whole_boundary_name;
  if (group.empty() || against.empty())
    return "Add a group of these facets of this body to the mesh, and name it as \"group\" and \"against\" of a "
           "[[contact]] with sliding = \"large\"";
  return fmt::format("Add\n[[contact]]\ngroup = \"{}\"\nagainst = \"{}\"\nsliding = \"large\"", group, against);
}

void PenetrationWatch::warn_at_contact(const SelfPenetration& found) const {
  const UnwatchedPenetration p = self_penetration_at_contact(found);
  log::warning(fmt::format(
      "{} {} penetrates itself by {} at {}, more than half a facet, although the contact of {} should keep that node "
      "out: "
      "{}; {}",
      words::when(p.time), p.bodies[0], words::depth_text(p), words::coordinates(p.position),
      pair_names(p.contact[0], p.contact[1]),
      pairs_[std::size_t(found.contact)].large_sliding
          ? "in one step its parts approached each other by more than the depth to which the contact detects them, or "
            "they were compressed to less than half of their thickness"
          : "the facets that faced each other at the start no longer do so",
      words::see_summary));
}

UnwatchedPenetration PenetrationWatch::self_penetration(const SelfPenetration& found) const {
  UnwatchedPenetration result = describe(found.deepest, {found.body});
  result.groups = groups_of_facet(found.own);
  result.through_groups = groups_of_facet(found.through);
  return result;
}

UnwatchedPenetration PenetrationWatch::self_penetration_at_contact(const SelfPenetration& found) const {
  UnwatchedPenetration result = describe(found.at_contact, {found.body});
  const ContactPair& contact = pairs_[std::size_t(found.contact)];
  result.contact = {contact.first_group(), contact.second_group()};
  return result;
}

std::vector<std::string> PenetrationWatch::groups_of_facet(const std::array<Index, 3>& nodes) const {
  std::vector<std::string> names;
  for (const BoundaryGroup& group : boundary_groups_) {
    const auto has = [&](Index node) { return node < 0 || std::ranges::binary_search(group.nodes, node); };
    if (std::ranges::all_of(nodes, has)) names.push_back(group.name);
  }
  return names;
}

}  // namespace ricochet
