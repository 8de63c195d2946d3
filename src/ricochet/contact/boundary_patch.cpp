#include "ricochet/contact/boundary_patch.hpp"

#include <algorithm>
#include <tuple>

namespace ricochet {

namespace {

using Patches = std::vector<std::unique_ptr<BoundaryPatch>>;

Patches collect_patches(const Body& body, const std::vector<ContactPair>& pairs) {
  Patches patches;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (pairs[k].tied) continue;
    const auto same = [&](const auto& patch) {
      return patch->obstacle == pairs[k].obstacle && patch->multipliers == pairs[k].multipliers;
    };
    auto patch = pairs[k].between_bodies() ? patches.end() : std::find_if(patches.begin(), patches.end(), same);
    if (patch == patches.end()) {
      patches.push_back(std::make_unique<BoundaryPatch>());
      patch = patches.end() - 1;
      (*patch)->obstacle = pairs[k].obstacle;
      (*patch)->multipliers = pairs[k].multipliers;
      (*patch)->facets.body = &body;
    }
    (*patch)->facets.parts.push_back({static_cast<int>(k), pairs[k].facets});
  }
  return patches;
}

void make_obstacle_patch(const Body& body, const BoundaryNodes& nodes, BoundaryPatch& patch) {
  const Obstacle* const obstacle = patch.obstacle;
  patch.facets.is_held = [&nodes, obstacle](Index node) { return nodes.is_held(node, obstacle); };
  patch.space = make_multiplier_space(patch.multipliers, patch.facets);
  patch.kept = patch.space->multipliers();
  // Those that could only press against supports are left out.
  std::erase_if(patch.kept,
                [&](const Multiplier& multiplier) { return only_presses_supports(multiplier, patch.facets); });
  take_obstacle_conditions(body, patch);
}

void make_body_patch(const Body& body, const ContactPair& pair, const FreeComponent& is_free, BoundaryPatch& patch,
                     PairFacing& facing) {
  const BodyPairing pairing(body, pair);
  patch.facets.parts.front().facets = pairing.facing_facets();
  patch.space = make_multiplier_space(patch.multipliers, patch.facets);
  if (!pairing.facing_facets().empty()) patch.bodies = pairing.make(*patch.space, is_free);
  patch.kept = patch.bodies.multipliers;
  patch.conditions = patch.bodies.conditions;
  facing = patch.bodies.facing;
}

/// Traces of tied nodes go on to those that they follow. A nodal force at a tied node is left out: its gap is a mean of
/// those of the nodes that it follows, on the same surface.
void follow_ties(const TiedNodes& tied, BoundaryPatch& patch) {
  const bool nodal = !patch.space->has_functions();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < patch.kept.size(); ++i) {
    for (const auto* const nodes : {&patch.kept[i].trace, &patch.conditions[i].opposite}) {
      for (const auto& [node, weight] : *nodes) {
        if (tied.is_tied(node)) patch.tied_nodes.push_back(node);
      }
    }
    if (nodal && tied.is_tied(patch.kept[i].node)) continue;
    patch.kept[i].trace = tied.spread(patch.kept[i].trace);
    patch.conditions[i].opposite = tied.spread(patch.conditions[i].opposite);
    if (kept != i) {
      patch.kept[kept] = std::move(patch.kept[i]);
      patch.conditions[kept] = std::move(patch.conditions[i]);
    }
    ++kept;
  }
  patch.kept.resize(kept);
  patch.conditions.resize(kept);
}

void number_points(const Patches& patches) {
  using Order = std::tuple<Index, int, std::size_t, std::size_t>;
  std::vector<Order> order;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p]->numbers.resize(patches[p]->kept.size());
    for (std::size_t i = 0; i < patches[p]->kept.size(); ++i) {
      const Multiplier& multiplier = patches[p]->kept[i];
      order.emplace_back(multiplier.node >= 0 ? multiplier.node : multiplier.trace.front().first, multiplier.pair, p,
                         i);
    }
  }
  std::sort(order.begin(), order.end());
  for (std::size_t number = 0; number < order.size(); ++number) {
    const auto& [node, pair, p, i] = order[number];
    patches[p]->numbers[i] = static_cast<int>(number);
  }
}

}  // namespace

Patches make_patches(const Body& body, const std::vector<ContactPair>& pairs, const BoundaryNodes& nodes,
                     const FreeComponent& is_free, std::vector<PairFacing>& facings) {
  Patches patches = collect_patches(body, pairs);
  facings.assign(pairs.size(), {});
  for (const auto& patch : patches) {
    const auto first = static_cast<std::size_t>(patch->first_pair());
    if (patch->obstacle != nullptr) {
      make_obstacle_patch(body, nodes, *patch);
    } else {
      make_body_patch(body, pairs[first], is_free, *patch, facings[first]);
    }
    if (body.tied != nullptr && !body.tied->empty()) follow_ties(*body.tied, *patch);
  }
  number_points(patches);
  return patches;
}

}  // namespace ricochet
