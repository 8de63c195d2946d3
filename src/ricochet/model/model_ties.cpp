#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/tied_surfaces.hpp"
#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file [[contact]] with tied = true.
namespace ricochet {

namespace {

/// Of the height of the cells: surfaces that are farther apart are not meant to be one.
constexpr double farthest_apart = 0.5;
/// The same from which a user hears that nodes have moved.
constexpr double moved = 1e-6;

void check_tie(const Case& input, std::size_t number, const ContactPair& pair, const TiedSurface& surface) {
  const std::string key = fmt::format("contact.{}.against", number);
  if (surface.ties.empty()) {
    refuse(input, key,
           fmt::format("nothing of groups \"{}\" and \"{}\" can be tied: seen along the normals of \"{}\" there is no "
                       "facet of \"{}\"; check which groups they are and where the bodies lie",
                       pair.group, pair.opposite_group, pair.group, pair.opposite_group));
  }
  if (surface.farthest_in_heights > farthest_apart) {
    refuse(input, key,
           fmt::format(
               "groups \"{}\" and \"{}\" are too far apart to be tied: by {:.3g} heights of a cell at ({:.6g}); "
               "move the bodies until the surfaces touch, or tie only what touches",
               pair.group, pair.opposite_group, surface.farthest_in_heights, fmt::join(surface.farthest_place, ", ")));
  }
  if (surface.farthest_in_heights > moved) {
    log::info(
        fmt::format("nodes of \"{}\" move by up to {:.2g} heights of a cell onto the surface of \"{}\", so that "
                    "turns have no strain",
                    pair.group, surface.farthest_in_heights, pair.opposite_group));
  }
  if (surface.facing.uncovered > 0) {
    log::warning(fmt::format("tied groups \"{}\" and \"{}\": {} the other surface and {} free", pair.group,
                             pair.opposite_group,
                             counted(surface.facing.uncovered, "node does not face", "nodes do not face"),
                             surface.facing.uncovered == 1 ? "stays" : "stay"));
  }
}

void move_nodes(const Case& input, Model& model) {
  const double off = move_tied_nodes(model.tied, model.mesh, model.space);
  try {
    gmsh::require_positive_cells(model.mesh,
                                 "the nodes of tied surfaces, which are moved onto the other surface, move");
  } catch (const Error& problem) {
    refuse(input, "contact",
           fmt::format("{}; mesh the surfaces so that they touch, or let the other one follow (multipliers_on)",
                       problem.what()));
  }
  if (off <= moved) return;
  model.contains_rotations = false;
  log::warning(
      fmt::format("tied surfaces are curved, and the displacement has nodes that the mesh does not have: these lie "
                  "off the mesh's edges by {:.2g} of a facet where they follow the other surface, so turns have "
                  "strain there; make the mesh of order {}",
                  off, input.mesh.degree));
}

}  // namespace

void add_ties(const Case& input, Model& model) {
  std::vector<TiedNodes::Tie> ties;
  std::vector<int> tied_by(static_cast<std::size_t>(model.space.node_count()), -1);
  for (std::size_t i = 0; i < model.contact_pairs.size(); ++i) {
    const ContactPair& pair = model.contact_pairs[i];
    if (!pair.tied) continue;
    TiedSurface surface;
    try {
      surface = tie_surfaces(model.body, pair);
    } catch (const Error& problem) {
      refuse(input, fmt::format("contact.{}.group", i), problem.what());
    }
    check_tie(input, i, pair, surface);
    for (TiedNodes::Tie& tie : surface.ties) {
      int& by = tied_by[static_cast<std::size_t>(tie.node)];
      if (by >= 0) {
        const Vector at = model.space.nodes.col(tie.node);
        refuse(input, fmt::format("contact.{}.group", i),
               fmt::format("the node at ({:.6g}) of group \"{}\" is tied already, by contact {}: it cannot follow two "
                           "surfaces; let the other group carry the multipliers (multipliers_on), or leave the facets "
                           "around the node out of one of the groups",
                           fmt::join(at, ", "), pair.group, by));
      }
      by = static_cast<int>(i);
      ties.push_back(std::move(tie));
    }
  }
  if (ties.empty()) return;
  try {
    model.tied = TiedNodes(std::move(ties), model.space.node_count());
  } catch (const Error& problem) {
    refuse(input, "contact", problem.what());
  }
  move_nodes(input, model);
  for (const TiedNodes::Tie& tie : model.tied.ties()) {
    for (const auto& [node, weight] : tie.weights) model.space.glued.emplace_back(tie.node, node);
  }
  model.body.tied = model.problem.tied = &model.tied;
}

}  // namespace ricochet
