#include "ricochet/contact/construction/boundary_patch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"

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
    auto patch = pairs[k].between_bodies() ? patches.end() : std::ranges::find_if(patches, same);
    if (patch == patches.end()) {
      patches.push_back(std::make_unique<BoundaryPatch>());
      patch = patches.end() - 1;
      (*patch)->obstacle = pairs[k].obstacle;
      (*patch)->multipliers = pairs[k].multipliers;
      (*patch)->facets.body = &body;
    }
    (*patch)->facets.parts.push_back({int(k), pairs[k].facets});
  }
  return patches;
}

void make_obstacle_patch(const Body& body, const BoundaryNodes& nodes, BoundaryPatch& patch) {
  const Obstacle* const obstacle = patch.obstacle;
  patch.facets.is_supported = [&nodes, obstacle](Index node) { return nodes.is_supported(node, obstacle); };
  patch.space = make_multiplier_space(patch.multipliers, patch.facets);
  patch.retained = patch.space->multipliers();
  // Multipliers that can only act on supports are omitted.
  std::erase_if(patch.retained,
                [&](const Multiplier& multiplier) { return only_presses_supports(multiplier, patch.facets); });
  compute_obstacle_conditions(body, patch);
}

void make_body_patch(const Body& body, const ContactPair& pair, const FreeComponent& is_free, BoundaryPatch& patch,
                     PairingSummary& facing) {
  const BodyPairing pairing(body, pair);
  patch.facets.parts.front().facets = pairing.facing_facets();
  patch.space = make_multiplier_space(patch.multipliers, patch.facets);
  if (pairing.facing_facets().empty()) return;
  BodyContact bodies = pairing.make(*patch.space, is_free);
  patch.retained = std::move(bodies.multipliers);
  patch.conditions = std::move(bodies.conditions);
  patch.nodes = std::move(bodies.nodes);
  patch.opposite_recovery = std::move(bodies.opposite_recovery);
  facing = bodies.facing;
}

/// Removes nodal forces at tied nodes: the gap of a tied node is a mean of those of the nodes to which it is tied, on
/// the same surface. These receive its share of the area, D' = D + Pᵀ D_s, and with it of the force, so that a uniform
/// pressure p still has the forces p D' and is recovered from them: of r' at the remaining nodes, a node had D/D' r',
/// and a tied one Σ P D_s/D' r'. Nodes of the tie inside the seam carry no contact.
void leave_out_tied_forces(const TiedNodes& tied, BoundaryPatch& patch) {
  std::vector<Multiplier> retained;
  std::vector<PointConditions> conditions;
  std::map<Index, int> number;
  for (std::size_t i = 0; i < patch.retained.size(); ++i) {
    if (tied.is_tied(patch.retained[i].node)) continue;
    number[patch.retained[i].node] = int(retained.size());
    retained.push_back(patch.retained[i]);
    conditions.push_back(patch.conditions[i]);
  }
  std::vector<Index> lost;
  std::vector<TiedNodes::Weights> areas(patch.retained.size());  // of each: (remaining multiplier, area assigned to it)
  for (std::size_t i = 0; i < patch.retained.size(); ++i) {
    const Multiplier& multiplier = patch.retained[i];
    double total = 0.0;
    for (const auto& [node, weight] : tied.spread({{multiplier.node, 1.0}})) {
      const auto at = number.find(node);
      if (at == number.end()) continue;
      areas[i].emplace_back(at->second, weight * multiplier.weight);
      total += weight;
    }
    if (!tied.is_tied(multiplier.node)) continue;
    if (areas[i].empty()) lost.push_back(multiplier.node);
    for (auto& [to, area] : areas[i]) {
      area = total > 0.0 ? area / total : 0.0;
      retained[std::size_t(to)].weight += area;
    }
  }
  if (!lost.empty()) {
    const Vector at = patch.facets.body->space->nodes.col(lost.front());
    log::warning(
        fmt::format("{} at tied nodes, first at ({:.6g}), and {} left out: no node that these follow is in the "
                    "contact; make the other surface follow (multipliers_on of the tie), or use multipliers \"p1\"",
                    counted(lost.size(), "contact point lies", "contact points lie"), fmt::join(at, ", "),
                    lost.size() == 1 ? "is" : "are"));
  }
  const auto redistribute = [&](std::vector<Eigen::Triplet<double>>& recovery) {
    std::vector<Eigen::Triplet<double>> result;
    for (const auto& entry : recovery) {
      for (const auto& [to, area] : areas[std::size_t(entry.col())]) {
        const double whole = retained[std::size_t(to)].weight;
        const double part = whole != 0.0 ? area / whole : 1.0;
        result.emplace_back(entry.row(), int(to), part * entry.value());
      }
    }
    recovery = std::move(result);
  };
  redistribute(patch.recovery);
  redistribute(patch.opposite_recovery);
  patch.retained = std::move(retained);
  patch.conditions = std::move(conditions);
}

/// Expresses traces on untied nodes. Positions of points, and nodal recovery, are unchanged.
void follow_ties(const TiedNodes& tied, BoundaryPatch& patch) {
  if (!patch.space->has_functions()) leave_out_tied_forces(tied, patch);
  for (PointConditions& conditions : patch.conditions) conditions.opposite = tied.spread(conditions.opposite);
  for (const Multiplier& multiplier : patch.retained) patch.free_traces.push_back(tied.spread(multiplier.trace));
}

void find_reached_nodes(BoundaryPatch& patch) {
  for (const Multiplier& multiplier : patch.retained) {
    for (const auto& [node, weight] : multiplier.trace) patch.reached.push_back(node);
  }
}

void number_points(const Patches& patches) {
  using Order = std::tuple<Index, int, std::size_t, std::size_t>;
  std::vector<Order> order;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p]->numbers.resize(patches[p]->retained.size());
    for (std::size_t i = 0; i < patches[p]->retained.size(); ++i) {
      const Multiplier& multiplier = patches[p]->retained[i];
      order.emplace_back(multiplier.node >= 0 ? multiplier.node : multiplier.trace.front().first, multiplier.pair, p,
                         i);
    }
  }
  std::ranges::sort(order);
  for (std::size_t number = 0; number < order.size(); ++number) {
    const auto& [node, pair, p, i] = order[number];
    patches[p]->numbers[i] = int(number);
  }
}

}  // namespace

Patches make_patches(const Body& body, const std::vector<ContactPair>& pairs, const BoundaryNodes& nodes,
                     const FreeComponent& is_free, std::vector<PairingSummary>& facings) {
  Patches patches = collect_patches(body, pairs);
  facings.assign(pairs.size(), {});
  const TiedNodes none;
  for (const auto& patch : patches) {
    const auto first = std::size_t(patch->first_pair());
    if (patch->obstacle != nullptr) {
      make_obstacle_patch(body, nodes, *patch);
    } else if (pairs[first].large_sliding) {
      make_sliding_patch(body, pairs[first], is_free, *patch, facings[first]);
    } else {
      make_body_patch(body, pairs[first], is_free, *patch, facings[first]);
    }
    if (!patch->retained.empty()) patch->recovery = patch->space->pressure_recovery(patch->retained);
    find_reached_nodes(*patch);
    follow_ties(body.tied != nullptr ? *body.tied : none, *patch);
  }
  number_points(patches);
  return patches;
}

}  // namespace ricochet
