#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/mortar/choose_side.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/model/model_parts.hpp"
#include "ricochet/problem/penetrating_points.hpp"
#include "ricochet/simulation/monitor/penetration_phrases.hpp"

/// @file [[contact]] between bodies: which side carries the multipliers, and how the groups face each other.
namespace ricochet {

namespace {

/// Length of the mean normal around a multiplier below which its direction is close to the normal of none of its
/// facets: facets that meet at an angle of more than 50 degrees.
constexpr double sharp_edge = 0.9;

std::string position_text(const Vector& point) { return fmt::format("({:.6g})", fmt::join(point, ", ")); }

std::string names_of_pair(const ContactPair& pair) {
  return fmt::format("contact groups \"{}\" and \"{}\"", pair.group, pair.opposite_group);
}

/// Overlap with an obstacle, relative to the mesh diameter, that straight facets in place of a curved surface may
/// cause.
constexpr double facet_deviation = 1e-3;

/// Warns of bodies that overlap at the displacement pair_at: they have moved past the position where they meet, so that
/// the facets that face each other there are not those that will touch.
void warn_of_overlap_where_paired(const Case& input, std::size_t number, const Model& model) {
  const ContactPair& pair = model.contact_pairs[number];
  if (pair.pair_at.size() == 0 || pair.closed_gaps) return;
  const ContactBoundary& contact = model.problem.contact;
  Vector gap = contact.initial_gap;
  for (Index i = 0; i < gap.size(); ++i) gap[i] += contact.rows->normal(i).dot(pair.pair_at);
  const PenetratingPoints overlap = penetrating_points(model.problem, gap, int(number));
  if (overlap.count == 0) return;
  log::warning(fmt::format(
      "{}: {} overlap at the displacement pair_at: {} inside the other body, the deepest by {:.3g} at {} of the mesh, "
      "so that facets are paired beyond the position where they will meet; set pair_at to the displacement at which "
      "the bodies begin to touch, or set initial_gap = \"closed\" if surfaces that touch overlap only because their "
      "facets are flat",
      input.where(fmt::format("contact.{}.pair_at", model.contacts[number].entry)).text(), names_of_pair(pair),
      counted(overlap.count, "contact point is", "contact points are"), overlap.deepest,
      position_text(overlap.position)));
}

/// Refuses a side that spans several bodies: large sliding distinguishes surfaces by their bodies.
void check_sliding_bodies(const Case& input, const std::string& key, const Model& model, const ContactPair& pair) {
  const std::vector<int> body_of_node = find_connected_bodies(model.space).of_node;
  const auto check = [&](const std::vector<Index>& facets, const char* name, const std::string& group) {
    std::set<int> bodies;
    for (const Index node : facet_nodes(model.space, facets)) bodies.insert(body_of_node[std::size_t(node)]);
    if (bodies.size() < 2) return;
    refuse(input, key + name,
           fmt::format("with sliding = \"large\" each side must be the surface of one body, but \"{}\" is on {} "
                       "bodies; use a separate contact for each of them",
                       group, bodies.size()));
  };
  check(pair.facets, "group", pair.group);
  check(pair.opposite_facets, "against", pair.opposite_group);
}

/// Warns of facets within which normals turn considerably: forces then depend on the side that carries the multipliers.
/// multiplier_side_test.py tests the advice.
void warn_of_side(const ContactPair& pair, const SideDoubt& doubt, bool is_chosen) {
  std::string advice;
  if (doubt.other_is_better && !is_chosen) {
    advice = fmt::format("leave multipliers_on out: with the multipliers on \"{}\" they vary by {:.2g}",
                         pair.opposite_group, doubt.other_variation);
    if (doubt.finer < 1.0) advice += fmt::format(", and facets there {:.2g} times as large", 0.9 * doubt.finer);
  } else {
    advice = fmt::format(
        "use facets of \"{}\" {:.2g} times as large where it or the surface that it touches is curved; a run with "
        "multipliers_on = \"{}\" shows by how much forces differ",
        pair.group, 0.9 * doubt.finer, pair.exchanged ? "group" : "against");
  }
  log::warning(
      fmt::format("contact of \"{}\" against \"{}\": normals vary by {:.2g} rad on average within the facets of "
                  "\"{}\", which carries the multipliers, and the forces of a contact that is no wider than a facet "
                  "may have a relative error of up to this size; {}",
                  pair.first_group(), pair.second_group(), doubt.variation, pair.group, advice));
}

/// Reports facets that are covered in part. Contact ends within such a facet, but its nodal values extend beyond that
/// end.
void report_partly_covered(const ContactPair& pair, const PairingSummary& facing) {
  constexpr double felt = 0.02;
  if (pair.tied || pair.large_sliding || facing.partly_covered <= felt * facing.covered) return;
  log::info(
      fmt::format("{}: {:.2g} % of the area in which they face each other is on facets of \"{}\" that are only partly "
                  "covered: areas in contact count such facets as a whole, and pressures at their nodes are "
                  "extrapolated (forces are correct); make facets end where the other surface ends, or put the "
                  "multipliers on the side whose facets do (multipliers_on)",
                  names_of_pair(pair), 100.0 * facing.partly_covered / facing.covered, pair.group));
}

}  // namespace

ContactPair body_pair(const Case& input, const ModelContact& section, const Model& model) {
  const std::string key = fmt::format("contact.{}.", section.entry);
  ContactPair pair;
  pair.group = section.group;
  pair.facets = section.facets;
  pair.opposite_group = section.against;
  pair.opposite_facets = section.opposite_facets;
  pair.is_one_of_many = !section.all_pairs_group.empty();
  pair.friction = {section.friction, section.friction_bound};
  pair.multipliers = section.multipliers;
  pair.closed_gaps = section.closed_gaps;
  pair.large_sliding = section.large_sliding;
  pair.tied = section.tied;
  if (!section.pair_at.empty())
    pair.pair_at = Eigen::Map<const Vector>(section.pair_at.data(), Index(section.pair_at.size()));
  std::vector<Index> common;
  std::set_intersection(pair.facets.begin(), pair.facets.end(), pair.opposite_facets.begin(),
                        pair.opposite_facets.end(), std::back_inserter(common));
  if (!common.empty() && !pair.is_self()) {
    refuse(input, key + "against",
           fmt::format("groups \"{}\" and \"{}\" share {}: the same facets cannot be on both sides of a contact; name "
                       "facets of one body in each",
                       section.group, section.against, counted(common.size(), "facet")));
  }
  if (pair.large_sliding && !pair.is_one_of_many) check_sliding_bodies(input, key, model, pair);
  if (pair.is_self()) {
    pair.side_reason = "the surface touches itself";
    return pair;
  }
  const bool is_chosen = section.multipliers_on == "automatic";
  const SideChoice choice =
      is_chosen ? choose_side(model.body, pair) : SideChoice{section.multipliers_on == "against", ""};
  if (choice.opposite) pair.exchange_sides();
  pair.side_reason = choice.reason;
  if (is_chosen && !pair.is_one_of_many) {
    log::info(fmt::format("contact of \"{}\" against \"{}\": {}: {}", section.group, section.against,
                          pair.tied ? "nodes of \"" + pair.group + "\" follow the other surface"
                                    : "group \"" + pair.group + "\" carries the multipliers",
                          choice.reason));
  }
  if (const std::optional<SideDoubt> doubt = doubt_side(model.body, pair); doubt) warn_of_side(pair, *doubt, is_chosen);
  return pair;
}

void check_facing(const Case& input, std::size_t number, const Model& model) {
  const ContactPair& pair = model.contact_pairs[number];
  const PairingSummary& facing = model.pair_facings[number];
  if (pair.large_sliding && !pair.is_one_of_many && facing.points + facing.held > 0 &&
      facing.uncovered == facing.points) {
    log::info(fmt::format("{} do not face each other at the start: contact begins once they do", names_of_pair(pair)));
  }
  if (facing.points == 0 && facing.held == 0) {
    if (pair.is_one_of_many) return;  // other pairs do
    refuse(input, fmt::format("contact.{}.against", model.contacts[number].entry),
           fmt::format(
               "{} do not face each other: seen along the normals of \"{}\" there is no facet of \"{}\"; check the "
               "groups and the positions of the bodies, {} the displacement of the body of \"{}\" at which they meet{}",
               names_of_pair(pair), pair.group, pair.opposite_group,
               pair.pair_at.size() > 0 ? "and that pair_at is" : "or set pair_at to", model.contacts[number].group,
               pair.pair_at.size() > 0
                   ? " (surfaces that it moves more than half a cell into each other count as having passed each other)"
                   : ""));
  }
  if (facing.held > 0) {
    log::warning(
        fmt::format("{}: {} held by supports on both sides in the direction of contact: no contact {} created there",
                    names_of_pair(pair), counted(facing.held, "multiplier is", "multipliers are"),
                    facing.held == 1 ? "point is" : "points are"));
  }
  report_partly_covered(pair, facing);
  if (facing.lost > 0) {
    log::warning(
        fmt::format("{}: {} left out of the contact, as curved facets are seen edge-on there; refine the mesh "
                    "at the rim of the contact",
                    names_of_pair(pair), counted(facing.lost, "piece of a facet is", "pieces of facets are")));
  }
  // Surfaces that overlap or are set to touch fit each other; their gaps are differences of positions that are wrong by
  // the distance of the facets from the curved surfaces.
  const double interference = std::max(-facing.smallest_gap, 0.0);
  constexpr double felt = 0.05;
  if (interference > facing.gap_rounding && (input.initial.static_equilibrium || facing.closed > 0)) {
    const double off = distance_from_curved(model.body, pair);
    if (off > felt * interference) {
      log::warning(fmt::format(
          "{}: the surfaces are curved, and their straight facets deviate from them by {:.2g} on average, compared "
          "with an overlap of {:.2g}: where meshes do not match, gaps and pressures are those of the facets, not of "
          "the curved surfaces; use a mesh of second order (mesh.degree = 2 creates one from a geometry)",
          names_of_pair(pair), off, interference));
    }
  }
  if (facing.closed > 0) {
    log::info(fmt::format("the meshes of {} overlap by up to {:.3g} at {}, where they are treated as touching",
                          names_of_pair(pair), -facing.smallest_gap, counted(facing.closed, "contact point")));
  }
  const bool has_edge = facing.agreement < sharp_edge && anchor_of(pair.multipliers) == MultiplierAnchor::node;
  if (has_edge && pair.large_sliding) {
    if (pair.is_one_of_many) return;
    log::info(
        fmt::format("{}: facets of \"{}\" meet at edges, the sharpest at {}, where a contact point averages over both "
                    "sides: the mesh should be fine where an edge itself presses",
                    names_of_pair(pair), pair.group, position_text(facing.edge)));
  } else if (has_edge) {
    log::warning(
        fmt::format("{}: facets of \"{}\" meet at an edge at {}, where the direction of contact is the mean of their "
                    "normals; use a separate contact for the facets on each side of the edge",
                    names_of_pair(pair), pair.group, position_text(facing.edge)));
  }
  warn_of_overlap_where_paired(input, number, model);
  if (pair.multipliers == "nodal" && !facing.matches) {
    log::warning(fmt::format(
        "{}: multipliers \"nodal\" on meshes that do not match: nodes of one side against facets of the other do not "
        "transmit a uniform pressure, and stresses near the contact can be wrong by tens of per cent; use \"p1\"",
        names_of_pair(pair)));
  }
}

void check_body_overlaps(const Case& input, const Model& model) {
  if (model.initial.static_equilibrium) return;  // press fit: the static start pushes the bodies apart
  Vector gap;
  model.problem.gaps(model.initial.displacement, 0.0, gap);
  for (std::size_t number = 0; number < model.contact_pairs.size(); ++number) {
    const ContactPair& pair = model.contact_pairs[number];
    if (!pair.between_bodies() || pair.tied) continue;
    const PenetratingPoints overlap = penetrating_points(model.problem, gap, int(number));
    if (overlap.count == 0) continue;
    refuse(
        input, fmt::format("contact.{}.group", model.contacts[number].entry),
        fmt::format(
            "{} overlap at the start: {} inside the other body, the deepest by {:.3g} at {}, and would be pushed out "
            "at once, which creates energy; move the bodies apart, set initial_gap = \"closed\" if surfaces that touch "
            "overlap only because their facets are flat, or set initial.displacement = \"static\" for a press fit",
            names_of_pair(pair), counted(overlap.count, "contact point is", "contact points are"), overlap.deepest,
            position_text(overlap.position)));
  }
}

namespace {

void refuse_overlap_with_obstacle(const Case& input, const Model& model, std::size_t number, const Vector& gap) {
  const ContactPair& pair = model.contact_pairs[number];
  const PenetratingPoints overlap =
      penetrating_points(model.problem, gap, int(number), facet_deviation * model.sizes.diameter);
  if (overlap.count == 0) return;
  // A static start pushes a body that is deeper inside through the obstacle: it is not where it is meant to be. (Bodies
  // that overlap by more than half a cell are not paired.)
  const bool may_be_press_fit = overlap.deepest <= node_spacing(model.space, pair.facets);
  const std::string side = penetration_phrases::check_side;
  const std::string remedy =
      may_be_press_fit ? "move one of them away, " + side + ", or set initial.displacement = \"static\" for a press fit"
                       : side + ", or move one of them away";
  refuse(input, fmt::format("contact.{}.group", model.contacts[number].entry),
         fmt::format("at the start {} of group \"{}\" {} inside obstacle \"{}\", the deepest by {:.3g} at {}, and "
                     "would be pushed out at once, which creates energy; {}",
                     counted(overlap.count, "contact point"), pair.group, overlap.count == 1 ? "is" : "are",
                     pair.obstacle_name, overlap.deepest, position_text(overlap.position), remedy));
}

}  // namespace

void refuse_bodies_inside_obstacles(const Case& input, const Model& model) {
  if (model.initial.static_equilibrium) return;
  Vector gap;
  model.problem.gaps(model.initial.displacement, 0.0, gap);
  for (std::size_t number = 0; number < model.contact_pairs.size(); ++number) {
    if (!model.contact_pairs[number].between_bodies()) refuse_overlap_with_obstacle(input, model, number, gap);
  }
}

}  // namespace ricochet
