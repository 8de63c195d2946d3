#include "ricochet/contact/tied_surfaces.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <map>
#include <set>

#include "ricochet/contact/facet_surface.hpp"

namespace ricochet {

namespace {

/// Weights below are rounding.
constexpr double least_weight = 1e-14;

/// P = C⁻¹ (M̂ − C_u) with the columns C_u of nodes that face nothing. Few nodes have more than themselves in C.
std::vector<TiedNodes::Tie> solve_ties(const BodyContact& contact) {
  std::map<Index, int> number, column;
  for (const Multiplier& multiplier : contact.multipliers) {
    const auto next = static_cast<int>(number.size());
    number[multiplier.node] = next;
  }
  std::vector<Index> followed;
  const auto column_of = [&](Index node) {
    const auto [entry, added] = column.try_emplace(node, static_cast<int>(followed.size()));
    if (added) followed.push_back(node);
    return entry->second;
  };
  std::vector<Eigen::Triplet<double>> own, others;
  for (std::size_t i = 0; i < contact.multipliers.size(); ++i) {
    const auto row = static_cast<int>(i);
    for (const auto& [node, weight] : contact.multipliers[i].trace) {
      if (weight == 0.0) continue;
      const auto known = number.find(node);
      if (known != number.end()) {
        own.emplace_back(row, known->second, weight);
      } else {
        others.emplace_back(row, column_of(node), -weight);
      }
    }
    for (const auto& [node, weight] : contact.conditions[i].opposite) {
      if (weight != 0.0) others.emplace_back(row, column_of(node), weight);
    }
  }
  const auto count = static_cast<Index>(number.size());
  SparseMatrix c(count, count), right(count, static_cast<Index>(followed.size()));
  c.setFromTriplets(own.begin(), own.end());
  right.setFromTriplets(others.begin(), others.end());
  const Eigen::SparseLU<SparseMatrix> factor(c);
  const SparseRowMatrix weights = SparseMatrix(factor.solve(right));
  std::vector<TiedNodes::Tie> ties;
  for (std::size_t i = 0; i < contact.multipliers.size(); ++i) {
    TiedNodes::Tie tie{contact.multipliers[i].node, {}};
    double sum = 0.0;
    for (SparseRowMatrix::InnerIterator entry(weights, number.at(tie.node)); entry; ++entry) {
      if (std::abs(entry.value()) < least_weight) continue;
      tie.weights.emplace_back(followed[static_cast<std::size_t>(entry.col())], entry.value());
      sum += entry.value();
    }
    for (auto& [node, weight] : tie.weights) weight /= sum;
    ties.push_back(std::move(tie));
  }
  return ties;
}

}  // namespace

TiedSurface tie_surfaces(const Body& body, const ContactPair& pair) {
  TiedSurface result;
  ContactPair dual = pair;
  dual.multipliers = "dual";
  const BodyPairing pairing(body, dual);
  if (pairing.facing_facets().empty()) return result;
  const ContactPatch patch{&body, {{0, pairing.facing_facets()}}};
  const std::unique_ptr<MultiplierSpace> space = make_multiplier_space(dual.multipliers, patch);
  const BodyContact contact = pairing.make(*space, [](Index, int) { return true; });
  result.facing = contact.facing;
  result.ties = solve_ties(contact);
  const FacetSurface own(body, pair.facets);
  for (const TiedNodes::Tie& tie : result.ties) {
    Vector apart = body.space->nodes.col(tie.node);
    for (const auto& [node, weight] : tie.weights) apart -= weight * body.space->nodes.col(node);
    const double distance = apart.norm() / own.height_at(tie.node);
    if (distance <= result.farthest) continue;
    result.farthest = distance;
    result.farthest_place = body.space->nodes.col(tie.node);
  }
  return result;
}

void move_tied_nodes(const TiedNodes& tied, Mesh& mesh, DisplacementSpace& space) {
  std::map<Index, Vector> moves;  // of the geometry's nodes
  const int d = mesh.dimension;
  Vector positions = space.nodes.reshaped();
  tied.complete(positions, d);
  for (std::size_t b = 0; b < space.facets.size(); ++b) {
    const CellBlock &nodes = space.facets[b], &geometry = mesh.facets[b];
    const int both = std::min(nodes.nodes_per_cell, geometry.nodes_per_cell);
    for (Index facet = 0; facet < nodes.size(); ++facet) {
      for (int k = 0; k < both; ++k) {
        const Index node = nodes.cell(facet)[k];
        if (tied.is_tied(node)) moves[geometry.cell(facet)[k]] = positions.segment(node * d, d) - space.nodes.col(node);
      }
    }
  }
  for (const auto& [node, move] : moves) mesh.nodes.col(node) += move;
  space.nodes = positions.reshaped(d, space.nodes.cols());
}

}  // namespace ricochet
