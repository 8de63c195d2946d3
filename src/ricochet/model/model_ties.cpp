#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/mortar/tied_surfaces.hpp"
#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file [[contact]] with tied = true.
namespace ricochet {

namespace {

/// Distance of the surfaces, in heights of a cell, beyond which they are not meant to be tied.
constexpr double farthest_apart = 0.5;
/// Displacement of nodes, in heights of a cell, from which it is reported.
constexpr double moved = 1e-6;
/// Displacement of nodes, in heights of a cell, from which it is warned of.
constexpr double large_displacement = 0.1;

void check_tie(const Case& input, std::size_t number, const ContactPair& pair, const TiedSurface& surface) {
  const std::string key = fmt::format("contact.{}.against", number);
  if (surface.ties.empty()) {
    refuse(input, key,
           fmt::format("groups \"{}\" and \"{}\" cannot be tied: seen along the normals of \"{}\" there is no facet of "
                       "\"{}\"; check the groups and the positions of the bodies",
                       pair.group, pair.opposite_group, pair.group, pair.opposite_group));
  }
  if (surface.farthest_in_heights > farthest_apart) {
    refuse(input, key,
           fmt::format("groups \"{}\" and \"{}\" are too far apart to be tied: by {:.3g} cell heights at ({:.6g}); "
                       "move the bodies until the surfaces touch, or tie only the parts that touch",
                       pair.group, pair.opposite_group, surface.farthest_in_heights,
                       fmt::join(surface.farthest_position, ", ")));
  }
  if (surface.farthest_in_heights > moved) {
    (surface.farthest_in_heights > large_displacement ? log::warning : log::info)(
        fmt::format("nodes of \"{}\" are moved by up to {:.2g} cell heights onto the surface of \"{}\", so that "
                    "rotations cause no strain",
                    pair.group, surface.farthest_in_heights, pair.opposite_group));
  }
  log::info(fmt::format("{} of \"{}\" {} \"{}\", on {:.3g} % of the area of \"{}\"",
                        counted(surface.ties.size(), "node"), pair.group,
                        surface.ties.size() == 1 ? "follows" : "follow", pair.opposite_group,
                        100.0 * surface.facing.covered / surface.facing.area, pair.group));
  if (surface.facing.uncovered > 0) {
    log::warning(fmt::format("tied groups \"{}\" and \"{}\": {} the other surface and {} free", pair.group,
                             pair.opposite_group,
                             counted(surface.facing.uncovered, "node does not face", "nodes do not face"),
                             surface.facing.uncovered == 1 ? "stays" : "stay"));
  }
}

/// Collects the ties of all contacts. At the rims of several surfaces that meet, a node may face more than one of them,
/// or face a node that itself follows it: it follows the first surface, which already satisfies the condition of the
/// second.
class TieCollection {
 public:
  TieCollection(const Case& input, const Model& model)
      : input_(input), model_(model), tied_by_(std::size_t(model.space.node_count()), -1) {}

  void add(std::size_t contact) {
    const ContactPair& pair = model_.contact_pairs[contact];
    TiedSurface surface = tie(contact, {});
    std::set<Index> excluded;
    for (const TiedNodes::Tie& tie : surface.ties) {
      if (is_tied(tie.node) || leads_to(tie.weights, tie.node)) excluded.insert(tie.node);
    }
    if (2 * excluded.size() > surface.ties.size()) refuse_second_tie(contact, *excluded.begin());
    if (!excluded.empty()) {
      surface = tie(contact, excluded);
      log::info(fmt::format("tied groups \"{}\" and \"{}\": {} another tied surface, too, and {} that surface",
                            pair.group, pair.opposite_group,
                            counted(excluded.size(), "node is at the rim of", "nodes are at the rim of"),
                            excluded.size() == 1 ? "follows" : "follow"));
    }
    check_tie(input_, model_.contacts[contact].entry, pair, surface);
    for (TiedNodes::Tie& tie : surface.ties) {
      tied_by_[std::size_t(tie.node)] = int(contact);
      tie_index_[tie.node] = ties_.size();
      ties_.push_back(std::move(tie));
    }
  }
  [[nodiscard]] std::vector<TiedNodes::Tie> release_ties() { return std::move(ties_); }

 private:
  [[nodiscard]] bool is_tied(Index node) const { return tied_by_[std::size_t(node)] >= 0; }
  /// Returns true if one of these nodes is the node itself or follows it.
  [[nodiscard]] bool leads_to(const TiedNodes::Weights& weights, Index node) const {
    return std::ranges::any_of(weights, [&](const auto& entry) {
      const auto at = tie_index_.find(entry.first);
      return entry.first == node || (at != tie_index_.end() && leads_to(ties_[at->second].weights, node));
    });
  }
  [[nodiscard]] TiedSurface tie(std::size_t contact, const std::set<Index>& excluded) const {
    return located(input_, fmt::format("contact.{}.group", model_.contacts[contact].entry), [&] {
      return tie_surfaces(model_.body, model_.contact_pairs[contact],
                          [&excluded](Index node) { return excluded.contains(node); });
    });
  }
  [[noreturn]] void refuse_second_tie(std::size_t contact, Index node) const {
    const Vector at = model_.space.nodes.col(node);
    const int by = tied_by_[std::size_t(node)];
    refuse(input_, fmt::format("contact.{}.group", model_.contacts[contact].entry),
           fmt::format("the node at ({:.6g}) of group \"{}\" and others {}: they cannot follow two surfaces; make the "
                       "other group follow (multipliers_on), leave the facets around them out of one of the groups, or "
                       "use one contact with a list of groups",
                       fmt::join(at, ", "), model_.contact_pairs[contact].group,
                       by >= 0 ? fmt::format("are already tied by contact {}", by)
                               : "are followed by the nodes that they would follow"));
  }

  const Case& input_;
  const Model& model_;
  std::vector<int> tied_by_;  ///< contact, or −1
  std::map<Index, std::size_t> tie_index_;
  std::vector<TiedNodes::Tie> ties_;
};

void move_nodes(const Case& input, Model& model) {
  const double off = move_tied_nodes(model.tied, model.mesh, model.space);
  try {
    gmsh::require_positive_cells(model.mesh,
                                 "the nodes of tied surfaces, which are moved onto the other surface, move");
  } catch (const Error& problem) {
    refuse(input, "contact",
           fmt::format("{}; mesh the surfaces so that they touch, or make the other surface follow (multipliers_on)",
                       problem.what()));
  }
  if (off <= moved) return;
  model.contains_rotations = false;
  log::warning(
      fmt::format("tied surfaces are curved, and the displacement has nodes that the mesh does not have: these lie off "
                  "the mesh's edges by {:.2g} of a facet where they follow the other surface, so that rotations cause "
                  "strain there; use a mesh of order {}",
                  off, input.mesh.degree));
}

}  // namespace

void add_ties(const Case& input, Model& model) {
  TieCollection collection(input, model);
  for (std::size_t i = 0; i < model.contact_pairs.size(); ++i) {
    if (model.contact_pairs[i].tied) collection.add(i);
  }
  std::vector<TiedNodes::Tie> ties = collection.release_ties();
  if (ties.empty()) return;
  located(input, "contact", [&] { model.tied = TiedNodes(std::move(ties), model.space.node_count()); });
  move_nodes(input, model);
  for (const TiedNodes::Tie& tie : model.tied.ties()) {
    for (const auto& [node, weight] : tie.weights) model.space.glued.emplace_back(tie.node, node);
  }
  model.body.tied = model.problem.tied = &model.tied;
}

void warn_of_torn_ties(const Model& model) {
  constexpr double rounding = 1e-9;
  if (model.tied.empty()) return;
  Vector completed = model.initial.velocity;
  model.tied.complete(completed, model.mesh.dimension);
  const double largest = model.initial.velocity.lpNorm<Eigen::Infinity>();
  const double torn = (completed - model.initial.velocity).lpNorm<Eigen::Infinity>();
  if (!(torn > rounding * largest)) return;
  log::warning(fmt::format(
      "tied bodies start with velocities that differ by up to {:.3g} at the tie: its nodes adopt the velocities of the "
      "other surface, and the initial momentum and energy are not those of the specified velocities",
      torn));
}

}  // namespace ricochet
