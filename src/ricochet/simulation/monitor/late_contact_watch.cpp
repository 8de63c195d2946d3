#include "ricochet/simulation/monitor/late_contact_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "ricochet/base/log.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/simulation/monitor/facet_sizes.hpp"

namespace ricochet {

/// Fraction of the allowance of the contact itself, which is half of the largest facet: smooth surfaces deviate by
/// h²/8R before they touch.
constexpr double allowed = 0.2;

LateContactWatch::LateContactWatch(const Body& body, const SemidiscreteProblem& problem,
                                   const std::vector<ContactPair>& pairs)
    : problem_(problem), pairs_(pairs) {
  const ContactBoundary& contact = problem.contact;
  std::map<int, std::vector<Node>> nodes;
  for (const ContactNodeAllowance& candidate :
       contact_node_allowances(body, contact, pairs, find_connected_bodies(*body.space).of_node)) {
    // Gaps are not known on the opposite side of a pair with large sliding.
    if (candidate.entry >= 0) nodes[candidate.contact].push_back({candidate.entry, allowed * candidate.allowance});
  }
  for (auto& [number, of_contact] : nodes) {
    Contact watched{std::size_t(number), {}, std::move(of_contact)};
    for (Index point = 0; point < contact.size(); ++point) {
      if (contact.pair[std::size_t(point)] == number) watched.points.push_back(point);
    }
    contacts_.push_back(std::move(watched));
  }
}

void LateContactWatch::check(const State& state) {
  bool gaps_evaluated = false;
  for (Contact& contact : contacts_) {
    if (contact.is_warned) continue;
    const bool acts =
        std::ranges::any_of(contact.points, [&](Index point) { return state.forces.normal_reaction[point] > 0.0; });
    if (acts) continue;
    if (!gaps_evaluated) problem_.node_gaps(state.displacement, state.time, gap_);
    gaps_evaluated = true;
    const auto inside =
        std::ranges::find_if(contact.nodes, [&](const Node& node) { return gap_[node.entry] < -node.allowance; });
    if (inside == contact.nodes.end()) continue;
    contact.is_warned = true;
    warn(contact, inside->entry, state.time);
  }
}

void LateContactWatch::warn(const Contact& contact, Index entry, double time) const {
  const ContactPair& pair = pairs_[contact.number];
  const Vector position = problem_.nodes.col(problem_.contact.nodes[std::size_t(entry)]);
  log::warning(fmt::format(
      "at t = {:.6g} a node at ({:.4g}) (reference position) is {:.3g} inside the other body, but the contact of "
      "\"{}\" and \"{}\" has no force yet: gaps are means over facets of \"{}\", which carries the multipliers, and "
      "contact with a corner or a ridge, which touches only a part of such a facet, is detected late; refine the mesh "
      "of \"{}\" there",
      time, fmt::join(position, ", "), -gap_[entry], pair.first_group(), pair.second_group(), pair.group, pair.group));
}

void LateContactWatch::persist(const SnapshotVisitor& visit) {
  Snapshot::Integers warned;
  for (const Contact& contact : contacts_) warned.push_back(contact.is_warned ? 1 : 0);
  visit("told", warned, {0, 1}, Index(warned.size()));
  for (std::size_t i = 0; i < contacts_.size(); ++i) contacts_[i].is_warned = warned[i] != 0;
}

}  // namespace ricochet
