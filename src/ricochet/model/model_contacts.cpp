#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/construction/make_contact_boundary.hpp"
#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/mortar/corner_pairs.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Obstacles and contacts of the case.
namespace ricochet {

namespace {

std::vector<Index> common_facets(const std::vector<Index>& one, const std::vector<Index>& other) {
  std::vector<Index> common;
  if (one.empty() || other.empty() || one.back() < other.front() || other.back() < one.front()) return common;
  std::set_intersection(one.begin(), one.end(), other.begin(), other.end(), std::back_inserter(common));
  return common;
}

/// Refuses facets that belong to two contacts: pressing them twice against the same obstacle is meaningless, and two
/// conditions between the same surfaces are linearly dependent.
void check_overlap(const Case& input, const Model& model) {
  const std::vector<ContactPair>& pairs = model.contact_pairs;
  const auto refuse_pair = [&](std::size_t i, std::size_t k, std::size_t facets, const std::string& against) {
    refuse(input, fmt::format("contact.{}.group", model.contacts[i].entry),
           fmt::format("contact groups \"{}\" and \"{}\" overlap: they share {} in contact with {}", pairs[k].group,
                       pairs[i].group, counted(facets, "facet"), against));
  };
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (pairs[i].obstacle != pairs[k].obstacle) continue;
      if (!pairs[i].between_bodies()) {
        const std::vector<Index> common = common_facets(pairs[i].facets, pairs[k].facets);
        if (!common.empty()) refuse_pair(i, k, common.size(), "the same " + pairs[i].opponent());
        continue;
      }
      for (const bool crosswise : {false, true}) {
        const auto &first = crosswise ? pairs[k].opposite_facets : pairs[k].facets,
                   &second = crosswise ? pairs[k].facets : pairs[k].opposite_facets;
        const std::vector<Index> own = common_facets(pairs[i].facets, first);
        if (own.empty() || common_facets(pairs[i].opposite_facets, second).empty()) continue;
        refuse_pair(i, k, own.size(), "the same facets of another group; one contact per pair of surfaces is enough");
      }
    }
  }
}

/// Warns of contact points without an area: nodal multipliers have none at the vertices of flat six-node triangles, so
/// that friction with a bound vanishes there.
void warn_of_bounds_without_area(const Model& model) {
  const ContactBoundary& contact = model.problem.contact;
  for (std::size_t k = 0; k < model.contacts.size(); ++k) {
    const ContactSection& section = model.contacts[k];
    if (section.friction_bound == 0.0) continue;
    double largest = 0.0;
    const auto of_pair = [&](Index point) { return contact.pair[std::size_t(point)] == int(k); };
    for (Index i = 0; i < contact.size(); ++i)
      largest = std::max(largest, of_pair(i) ? contact.friction_bound[i] : 0.0);
    Index without = 0;
    for (Index i = 0; i < contact.size(); ++i) without += of_pair(i) && contact.friction_bound[i] <= 1e-10 * largest;
    if (without == 0) continue;
    log::warning(fmt::format(
        "contact of group \"{}\": with multipliers \"{}\" no friction acts at {}, whose share of the area is zero, "
        "since friction_bound is a force per area; use multipliers \"dual\" or \"p1\"",
        section.group, section.multipliers, counted(without, "contact point")));
  }
}

/// Refuses, or warns of, multipliers that are unstable with the displacement's degree on the facets of a group.
void check_stability(const Case& input, const ModelContact& section, const Model& model) {
  for (const Index facet : model.contact_pairs.back().facets) {
    const CellShape shape = model.space.facets[locate_facet(model.space, facet).block].shape;
    const std::string reason = instability(section.multipliers, shape, model.space.degree);
    if (reason.empty()) continue;
    if (!section.allow_unstable_multipliers) {
      refuse(input, fmt::format("contact.{}.multipliers", section.entry),
             fmt::format("{} (unstable_multipliers = \"allow\" permits the run anyway)", reason));
    }
    log::warning(
        fmt::format("contact of group \"{}\": {}; pressures may oscillate from point to point", section.group, reason));
    return;
  }
}

/// Adds the pairs of corners after all others, whose numbers users see.
void add_corners(Model& model) {
  const std::size_t pairs = model.contact_pairs.size();
  for (std::size_t i = 0; i < pairs; ++i) {
    const std::optional<ContactPair> corners = corner_pair(model.body, model.contact_pairs[i]);
    if (!corners) continue;
    model.contacts.push_back(ModelContact(model.contacts[i]));
    model.contact_pairs.push_back(*corners);
    model.problem.obstacles.push_back(nullptr);
  }
}

ContactPair obstacle_pair(const Case& input, const ModelContact& section, const Model& model) {
  ContactPair pair;
  pair.group = section.group;
  pair.facets = section.facets;
  pair.obstacle_name = section.obstacle;
  for (std::size_t k = 0; k < input.obstacles.size(); ++k) {
    if (input.obstacles[k].name == section.obstacle) pair.obstacle = model.obstacles[k].get();
  }
  pair.friction = {section.friction, section.friction_bound};
  pair.multipliers = section.multipliers;
  return pair;
}

}  // namespace

void make_obstacles(const Case& input, Model& model, int dimension) {
  for (const ObstacleSection& section : input.obstacles) {
    model.obstacles.push_back(make_obstacle(input, section, dimension));
    check_axisymmetric_obstacle(input, section, *model.obstacles.back());
  }
}

void collect_contacts(const Case& input, Model& model) {
  model.contacts = find_contacts(input, model);
  for (const ModelContact& contact : model.contacts) {
    model.contact_pairs.push_back(contact.between_bodies() ? body_pair(input, contact, model)
                                                           : obstacle_pair(input, contact, model));
    model.problem.obstacles.push_back(model.contact_pairs.back().obstacle);
    if (!model.contact_pairs.back().tied) check_stability(input, contact, model);
  }
  check_overlap(input, model);
  add_corners(model);
  fit_obstacles(input, model);
}

void add_contacts(const Case& input, Model& model) {
  const int d = model.mesh.dimension;
  const auto is_free = [&](Index node, int component) {
    return !model.problem.supports.contains(node * d + component);
  };
  Index supported = 0;
  located(input, "contact", [&] {
    model.problem.contact =
        make_contact_boundary(model.body, model.contact_pairs, is_free, &supported, &model.pair_facings);
  });
  for (std::size_t i = 0; i < model.contacts.size(); ++i) {
    if (model.contact_pairs[i].has_two_sides() && !model.contact_pairs[i].at_corners) check_facing(input, i, model);
  }
  model.problem.contact_stress = [&model] { return make_contact_stress(model.body, model.problem.contact); };
  warn_of_bounds_without_area(model);
  if (supported > 0) {
    log::warning(
        fmt::format("{} held by supports in the direction of the obstacle's normal: no contact {} created there",
                    counted(supported, "node of contact boundaries is", "nodes of contact boundaries are"),
                    supported == 1 ? "point is" : "points are"));
  }
}

}  // namespace ricochet
