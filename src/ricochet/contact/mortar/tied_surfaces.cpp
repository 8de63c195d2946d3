#include "ricochet/contact/mortar/tied_surfaces.hpp"

#include <fmt/format.h>

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/base/point_sets.hpp"
#include "ricochet/contact/mortar/facet_surface.hpp"
#include "ricochet/fem/reference_element.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Weight below which an entry is rounding error.
constexpr double least_weight = 1e-14;

/// Tolerance of Σ P = 1, for the rounding error of the solution.
constexpr double rounding_of_sum = 1e-9;

/// Removes the multipliers of nodes that are to remain free, and of those that do not face the other surface
/// themselves, although a part of their facets does: P would have entries extrapolated by a cell size over that part.
void leave_out_overhanging(BodyContact& contact, const std::function<bool(Index)>& stays_free) {
  std::set<Index> facing;
  for (const BodyContact::Node& node : contact.nodes) {
    if (node.own && !node.opposite.empty()) facing.insert(node.node);
  }
  contact.facing.uncovered +=
      contact.keep([&](const Multiplier& multiplier, const auto&) { return facing.contains(multiplier.node); });
  if (stays_free) contact.keep([&](const Multiplier& multiplier, const auto&) { return !stays_free(multiplier.node); });
}

/// Computes P = C⁻¹ (M̂ − C_u) with the columns C_u of nodes that remain free. C is diagonal except for a few nodes.
std::vector<TiedNodes::Tie> solve_ties(const BodyContact& contact) {
  std::map<Index, int> number, column;
  for (const Multiplier& multiplier : contact.multipliers) {
    const auto next = int(number.size());
    number[multiplier.node] = next;
  }
  std::vector<Index> followed;
  const auto column_of = [&](Index node) {
    const auto [entry, added] = column.try_emplace(node, int(followed.size()));
    if (added) followed.push_back(node);
    return entry->second;
  };
  std::vector<Eigen::Triplet<double>> own, others;
  for (std::size_t i = 0; i < contact.multipliers.size(); ++i) {
    const auto row = int(i);
    for (const auto& [node, weight] : contact.multipliers[i].trace) {
      if (weight == 0.0) continue;
      const auto found = number.find(node);
      if (found != number.end()) {
        own.emplace_back(row, found->second, weight);
      } else {
        others.emplace_back(row, column_of(node), -weight);
      }
    }
    for (const auto& [node, weight] : contact.conditions[i].opposite) {
      if (weight != 0.0) others.emplace_back(row, column_of(node), weight);
    }
  }
  const auto count = Index(number.size());
  SparseMatrix c(count, count), right(count, Index(followed.size()));
  c.setFromTriplets(own.begin(), own.end());
  right.setFromTriplets(others.begin(), others.end());
  if (count == 0) return {};
  const Eigen::SparseLU<SparseMatrix> factor(c);
  if (factor.info() != Eigen::Success)
    throw Error(ErrorKind::invalid_input,
                "the surfaces cannot be tied: the conditions of their nodes depend on each other");
  const SparseRowMatrix weights = SparseMatrix(factor.solve(right));
  std::vector<TiedNodes::Tie> ties;
  for (std::size_t i = 0; i < contact.multipliers.size(); ++i) {
    TiedNodes::Tie tie{contact.multipliers[i].node, {}};
    double sum = 0.0;
    for (SparseRowMatrix::InnerIterator entry(weights, number.at(tie.node)); entry; ++entry) {
      if (std::abs(entry.value()) < least_weight) continue;
      tie.weights.emplace_back(followed[std::size_t(entry.col())], entry.value());
      sum += entry.value();
    }
    if (!(std::abs(sum - 1.0) <= rounding_of_sum))
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("the surfaces cannot be tied: a node would follow {:g} times the motion of the other surface",
                      sum));
    for (auto& [node, weight] : tie.weights) weight /= sum;
    ties.push_back(std::move(tie));
  }
  return ties;
}

/// Largest distance of a tied node from its position in the geometry, relative to the size of its facet.
double distance_from_geometry(const TiedNodes& tied, const Mesh& mesh, const DisplacementSpace& space) {
  double largest = 0.0;
  for (std::size_t b = 0; b < space.facets.size(); ++b) {
    const CellBlock &nodes = space.facets[b], &geometry = mesh.facets[b];
    const Points& points = ReferenceElement::get(nodes.shape, space.degree).nodes();
    const Tabulation map = ReferenceElement::get(nodes.shape, mesh.degree).tabulate(points);
    for (Index facet = 0; facet < nodes.size(); ++facet) {
      Points corners(mesh.dimension, geometry.nodes_per_cell);
      for (int k = 0; k < geometry.nodes_per_cell; ++k) corners.col(k) = mesh.nodes.col(geometry.cell(facet)[k]);
      const double size = largest_distance(corners);
      for (int k = 0; k < nodes.nodes_per_cell; ++k) {
        const Index node = nodes.cell(facet)[k];
        if (!tied.is_tied(node)) continue;
        largest = std::max(largest, (space.nodes.col(node) - corners * map.values.col(k)).norm() / size);
      }
    }
  }
  return largest;
}

}  // namespace

TiedSurface tie_surfaces(const Body& body, const ContactPair& pair, const std::function<bool(Index)>& stays_free) {
  TiedSurface result;
  ContactPair dual = pair;
  dual.multipliers = "dual";
  const BodyPairing pairing(body, dual);
  if (pairing.facing_facets().empty()) return result;
  const ContactPatch patch{&body, {{0, pairing.facing_facets()}}};
  const std::unique_ptr<MultiplierSpace> space = make_multiplier_space(dual.multipliers, patch);
  BodyContact contact = pairing.make(*space, [](Index, int) { return true; });
  leave_out_overhanging(contact, stays_free);
  result.facing = contact.facing;
  result.ties = solve_ties(contact);
  const FacetSurface own(body, pair.facets);
  for (const TiedNodes::Tie& tie : result.ties) {
    Vector apart = body.space->nodes.col(tie.node);
    for (const auto& [node, weight] : tie.weights) apart -= weight * body.space->nodes.col(node);
    const double distance = apart.norm() / own.height_at(tie.node);
    if (distance <= result.farthest_in_heights) continue;
    result.farthest_in_heights = distance;
    result.farthest_position = body.space->nodes.col(tie.node);
  }
  return result;
}

double move_tied_nodes(const TiedNodes& tied, Mesh& mesh, DisplacementSpace& space) {
  std::map<Index, Vector> moves;  // of the nodes of the geometry
  const int d = mesh.dimension;
  Vector positions = space.nodes.reshaped();
  tied.complete(positions, d);
  const auto moved = [&](Index node) { return Vector(positions.segment(node * d, d) - space.nodes.col(node)); };
  for (std::size_t b = 0; b < space.facets.size(); ++b) {
    const CellBlock &nodes = space.facets[b], &geometry = mesh.facets[b];
    const auto& vertices_of = node_vertices(geometry.shape, mesh.degree);
    for (Index facet = 0; facet < nodes.size(); ++facet) {
      const Index *own = nodes.cell(facet), *at = geometry.cell(facet);
      for (int k = 0; k < geometry.nodes_per_cell; ++k) {
        if (k < nodes.nodes_per_cell) {
          if (tied.is_tied(own[k])) moves[at[k]] = moved(own[k]);
          continue;
        }
        // Nodes of the geometry that the displacement does not have move with the vertices around them.
        const std::vector<int>& vertices = vertices_of[std::size_t(k)];
        if (!std::ranges::all_of(vertices, [&](int v) { return tied.is_tied(own[v]); })) continue;
        Vector mean = Vector::Zero(d);
        for (const int v : vertices) mean += moved(own[v]) / double(vertices.size());
        moves[at[k]] = mean;
      }
    }
  }
  for (const auto& [node, move] : moves) mesh.nodes.col(node) += move;
  space.nodes = positions.reshaped(d, space.nodes.cols());
  return distance_from_geometry(tied, mesh, space);
}

}  // namespace ricochet
