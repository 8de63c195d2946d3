#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Contact of every body with every other: a [[contact]] with neither an obstacle nor another group.
namespace ricochet {

namespace {

/// Returns the name of a body without the prefix of messages: "ball" for "body "ball"", "0" for "body 0".
std::string short_name(const std::string& name) {
  std::string result = name.starts_with("body ") ? name.substr(5) : name;
  std::erase(result, '"');
  return result;
}

class PairFinder {
 public:
  PairFinder(const Case& input, const Model& model)
      : input_(input),
        model_(model),
        bodies_(find_connected_bodies(model.space)),
        names_(names_of_bodies(model.mesh, bodies_)) {}

  /// Excludes pairs of bodies that have a contact of their own, and facets that are tied, from the contacts of all
  /// pairs.
  void exclude(const ModelContact& contact) {
    for (const int one : bodies_on(contact.facets)) {
      for (const int other : bodies_on(contact.opposite_facets)) excluded_pairs_.insert(std::minmax(one, other));
    }
    if (!contact.tied) return;
    for (const auto* const facets : {&contact.facets, &contact.opposite_facets}) {
      for (const Index node : facet_nodes(model_.space, *facets)) tied_.insert(node);
    }
  }

  void add(const ModelContact& of_all, std::vector<ModelContact>& contacts) const {
    std::vector<std::vector<Index>> surfaces(static_cast<std::size_t>(bodies_.count));
    for (const Index facet : of_all.facets) {
      const std::vector<Index> nodes = facet_nodes(model_.space, {facet});
      if (std::ranges::any_of(nodes, [&](Index node) { return tied_.contains(node); })) continue;
      surfaces[std::size_t(body_of(nodes.front()))].push_back(facet);
    }
    const std::size_t before = contacts.size();
    std::size_t count = 0, left_out = 0;
    for (int i = 0; i < bodies_.count; ++i) {
      if (surfaces[std::size_t(i)].empty()) continue;
      ++count;
      for (int j = i + 1; j < bodies_.count; ++j) {
        if (surfaces[std::size_t(j)].empty()) continue;
        if (excluded_pairs_.contains({i, j})) {
          ++left_out;
        } else {
          contacts.push_back(pair_of(of_all, i, j, surfaces));
        }
      }
    }
    check_count(of_all, count);
    log::info(fmt::format(
        "contact of every body of \"{}\" against every other: {}, {}{}", of_all.group, counted(count, "body", "bodies"),
        counted(contacts.size() - before, "pair"),
        left_out > 0 ? fmt::format("; {} a contact of {} own", counted(left_out, "other pair has", "other pairs have"),
                                   left_out == 1 ? "its" : "their")
                     : ""));
  }

 private:
  [[nodiscard]] int body_of(Index node) const { return bodies_.of_node[std::size_t(node)]; }

  [[nodiscard]] std::set<int> bodies_on(const std::vector<Index>& facets) const {
    std::set<int> result;
    for (const Index node : facet_nodes(model_.space, facets)) result.insert(body_of(node));
    return result;
  }

  [[nodiscard]] ModelContact pair_of(const ModelContact& of_all, int one, int other,
                                     const std::vector<std::vector<Index>>& surfaces) const {
    ModelContact pair = of_all;
    pair.all_pairs_group = of_all.group;
    pair.group = short_name(names_[std::size_t(one)]);
    pair.against = short_name(names_[std::size_t(other)]);
    pair.facets = surfaces[std::size_t(one)];
    pair.opposite_facets = surfaces[std::size_t(other)];
    return pair;
  }

  void check_count(const ModelContact& of_all, std::size_t count) const {
    if (count > 1) return;
    refuse(input_, fmt::format("contact.{}.group", of_all.entry),
           fmt::format(
               "contact of every body against every other: \"{}\" is on {}, {}; add an \"obstacle\" or \"against\" to "
               "[[contact]]; \"against\" can be the group itself, for a surface that touches itself",
               of_all.group, counted(count, "body", "bodies"),
               count == 0 ? "apart from tied surfaces" : "and there is no other body"));
  }

  const Case& input_;
  const Model& model_;
  ConnectedBodies bodies_;
  std::vector<std::string> names_;
  std::set<std::pair<int, int>> excluded_pairs_;
  std::set<Index> tied_;
};

}  // namespace

std::vector<ModelContact> find_contacts(const Case& input, const Model& model) {
  std::vector<ModelContact> entries;
  bool any = false;
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    ModelContact& contact = entries.emplace_back(ModelContact{input.contacts[i], i, {}, {}});
    const std::string key = fmt::format("contact.{}.", i);
    contact.facets = boundary_at(input, key + "group", model.mesh, contact.group);
    if (!contact.against.empty())
      contact.opposite_facets = boundary_at(input, key + "against", model.mesh, contact.against);
    any = any || contact.is_of_all_pairs();
  }
  if (!any) return entries;
  PairFinder finder(input, model);
  std::vector<ModelContact> contacts;
  for (const ModelContact& contact : entries) finder.exclude(contact);
  for (const ModelContact& contact : entries) {
    if (contact.is_of_all_pairs()) {
      finder.add(contact, contacts);
    } else {
      contacts.push_back(contact);
    }
  }
  return contacts;
}

}  // namespace ricochet
