#include "ricochet/contact/contact_boundary.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// d × (d−1) orthonormal directions that complete the normal; in 2D (1, 0) for the normal (0, 1).
Points tangents_of(const Vector& normal) {
  Points result(normal.size(), normal.size() - 1);
  if (normal.size() == 2) {
    result << normal[1], -normal[0];
    return result;
  }
  // The axis least aligned with the normal gives a well-conditioned first tangent.
  Index axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d n = normal;
  const Eigen::Vector3d first = Eigen::Vector3d::Unit(axis).cross(n).normalized();
  result.col(0) = first;
  result.col(1) = n.cross(first);
  return result;
}

/// One contact point before numbering.
struct Point {
  Index node = 0;
  int pair = 0;
  double weight = 0.0;
};

/// ∫ φ_i over the facets of a pair, for all nodes of the space.
Vector nodal_weights(const Body& body, const std::vector<Index>& facets) {
  const int d = body.space->dimension;
  Vector load = Vector::Zero(body.space->dof_count());
  add_facet_load(
      body, facets, [](const Vector&, Vector& force) { force = Vector::Unit(force.size(), 0); }, load);
  return Eigen::Map<const Vector, 0, Eigen::InnerStride<>>(load.data(), body.space->node_count(),
                                                           Eigen::InnerStride<>(d));
}

/// All points of all pairs; a node that several groups bring against the same obstacle is one point.
std::vector<Point> collect_points(const Body& body, const std::vector<ContactPair>& pairs,
                                  const std::function<bool(Index, const Vector&)>& keep) {
  std::vector<Point> points;
  std::map<std::pair<Index, const Obstacle*>, std::size_t> known;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Vector weights = nodal_weights(body, pairs[k].facets);
    for (const Index node : facet_nodes(*body.space, pairs[k].facets)) {
      if (!keep(node, pairs[k].obstacle->normal(body.space->nodes.col(node)))) continue;
      const auto [entry, added] = known.try_emplace({node, pairs[k].obstacle}, points.size());
      if (added) {
        points.push_back({node, static_cast<int>(k), weights[node]});
        continue;
      }
      Point& point = points[entry->second];
      point.weight += weights[node];
      const ContactPair& other = pairs[static_cast<std::size_t>(point.pair)];
      if (other.friction_coefficient != pairs[k].friction_coefficient) {
        throw Error(ErrorKind::invalid_input,
                    fmt::format("contact groups \"{}\" and \"{}\" share a node against obstacle \"{}\" with different "
                                "friction coefficients; separate them by at least one facet or give them the same",
                                other.group, pairs[k].group, pairs[k].obstacle_name));
      }
    }
  }
  std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.node < b.node; });
  return points;
}

/// The conditions at one node must be independent, or their forces are not determined.
void check_independence(const ContactBoundary& boundary, const Body& body, const std::vector<ContactPair>& pairs) {
  for (Index i = 0; i < boundary.size();) {
    Index end = i + 1;
    while (end < boundary.size() &&
           boundary.nodes[static_cast<std::size_t>(end)] == boundary.nodes[static_cast<std::size_t>(i)])
      ++end;
    if (end - i > 1) {
      Eigen::ColPivHouseholderQR<Matrix> qr(boundary.normals.middleCols(i, end - i));
      qr.setThreshold(1e-8);
      if (qr.rank() < end - i) {
        std::string names;
        for (Index k = i; k < end; ++k) {
          const auto pair = static_cast<std::size_t>(boundary.pair[static_cast<std::size_t>(k)]);
          names += fmt::format("{}\"{}\"", k == i ? "" : ", ", pairs[pair].obstacle_name);
        }
        const Vector at = body.space->nodes.col(boundary.nodes[static_cast<std::size_t>(i)]);
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("the node at ({}{}{}) is in contact with obstacles {} whose normals are linearly "
                        "dependent there; remove one of these contacts",
                        at[0], ", ", at.size() == 3 ? fmt::format("{}, {}", at[1], at[2]) : fmt::format("{}", at[1]),
                        names));
      }
    }
    i = end;
  }
}

void fill_operators(ContactBoundary& boundary, Index dofs) {
  const int d = boundary.dimension;
  std::vector<Eigen::Triplet<double>> gap, slip;
  for (Index i = 0; i < boundary.size(); ++i) {
    const auto first = static_cast<int>(boundary.nodes[static_cast<std::size_t>(i)] * d);
    for (int k = 0; k < d; ++k) {
      gap.emplace_back(static_cast<int>(i), first + k, boundary.normals(k, i));
      for (int j = 0; j < d - 1; ++j) {
        slip.emplace_back(static_cast<int>(i) * (d - 1) + j, first + k,
                          boundary.tangents[static_cast<std::size_t>(i)](k, j));
      }
    }
  }
  boundary.gap_operator.resize(boundary.size(), dofs);
  boundary.gap_operator.setFromTriplets(gap.begin(), gap.end());
  boundary.tangential_trace.resize(boundary.size() * (d - 1), dofs);
  boundary.tangential_trace.setFromTriplets(slip.begin(), slip.end());
}

/// For each non-vertex node of the pair's facets, the vertices it lies between.
std::map<Index, std::vector<Index>> middle_nodes(const DisplacementSpace& space, const std::vector<Index>& facets) {
  std::map<Index, std::vector<Index>> middles;
  Index first = 0;
  for (const CellBlock& block : space.facets) {
    const auto& support = node_vertices(block.shape, space.degree);
    for (const Index facet : facets) {
      const Index local = facet - first;
      if (local < 0 || local >= block.size()) continue;
      for (std::size_t k = 0; k < support.size(); ++k) {
        if (support[k].size() == 1) continue;
        std::vector<Index>& vertices = middles[block.cell(local)[k]];
        vertices.clear();
        for (const int v : support[k]) vertices.push_back(block.cell(local)[v]);
      }
    }
    first += block.size();
  }
  return middles;
}

void fill_pressure_recovery(ContactBoundary& boundary, const DisplacementSpace& space,
                            const std::vector<ContactPair>& pairs) {
  const Index count = boundary.size();
  std::map<std::pair<Index, const Obstacle*>, Index> number;
  for (Index i = 0; i < count; ++i) {
    const auto pair = static_cast<std::size_t>(boundary.pair[static_cast<std::size_t>(i)]);
    number[{boundary.nodes[static_cast<std::size_t>(i)], pairs[pair].obstacle}] = i;
  }
  // gather(a, j) = ψ_a(x_j): the identity on degree 1.
  std::vector<Eigen::Triplet<double>> gather, spread;
  std::vector<char> is_middle(static_cast<std::size_t>(count), 0);
  std::map<Index, std::vector<Index>> middles;
  for (const ContactPair& pair : pairs) {
    for (const auto& [node, vertices] : middle_nodes(space, pair.facets)) {
      const auto point = number.find({node, pair.obstacle});
      if (point == number.end() || is_middle[static_cast<std::size_t>(point->second)] != 0) continue;
      is_middle[static_cast<std::size_t>(point->second)] = 1;
      std::vector<Index> known;
      for (const Index vertex : vertices) {
        const auto found = number.find({vertex, pair.obstacle});
        if (found != number.end()) known.push_back(found->second);
      }
      // Where supports have removed the vertices, the middle keeps its force to itself.
      if (known.empty()) is_middle[static_cast<std::size_t>(point->second)] = 0;
      for (const Index vertex : known) {
        const double share = 1.0 / static_cast<double>(known.size());
        gather.emplace_back(static_cast<int>(vertex), static_cast<int>(point->second), share);
        spread.emplace_back(static_cast<int>(point->second), static_cast<int>(vertex), share);
      }
    }
  }
  for (Index i = 0; i < count; ++i) {
    if (is_middle[static_cast<std::size_t>(i)] != 0) continue;
    gather.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
    spread.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
  }
  SparseRowMatrix gathering(count, count), spreading(count, count);
  gathering.setFromTriplets(gather.begin(), gather.end());
  spreading.setFromTriplets(spread.begin(), spread.end());
  const Vector weights = gathering * boundary.weights;
  for (Index row = 0; row < count; ++row) {
    for (SparseRowMatrix::InnerIterator entry(gathering, row); entry; ++entry) entry.valueRef() /= weights[row];
  }
  boundary.pressure_recovery = spreading * gathering;
}

}  // namespace

std::vector<Index> ContactBoundary::unique_nodes() const {
  std::vector<Index> result = nodes;  // ascending already
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

ContactBoundary make_contact_boundary(const Body& body, const std::vector<ContactPair>& pairs,
                                      const std::function<bool(Index, const Vector&)>& keep) {
  const std::vector<Point> points = collect_points(body, pairs, keep);
  ContactBoundary boundary;
  boundary.dimension = body.space->dimension;
  const auto count = static_cast<Index>(points.size());
  boundary.normals.resize(boundary.dimension, count);
  boundary.initial_gap.resize(count);
  boundary.gap_rounding.resize(count);
  boundary.weights.resize(count);
  boundary.friction_coefficient.resize(count);
  // Displacements come from solves over the whole body, so their rounding is relative to its size, wherever a node is.
  const double body_size = extent(*body.space);
  const double body_rounding = 8.0 * std::numeric_limits<double>::epsilon() * body_size;
  for (Index i = 0; i < count; ++i) {
    const Point& point = points[static_cast<std::size_t>(i)];
    const ContactPair& pair = pairs[static_cast<std::size_t>(point.pair)];
    const Vector position = body.space->nodes.col(point.node);
    boundary.nodes.push_back(point.node);
    boundary.pair.push_back(point.pair);
    boundary.normals.col(i) = pair.obstacle->normal(position);
    boundary.tangents.push_back(tangents_of(boundary.normals.col(i)));
    boundary.initial_gap[i] = pair.obstacle->gap(position);
    boundary.gap_rounding[i] = pair.obstacle->gap_rounding(position) + body_rounding;
    boundary.weights[i] = point.weight;
    boundary.friction_coefficient[i] = pair.friction_coefficient;
  }
  check_independence(boundary, body, pairs);
  fill_operators(boundary, body.space->dof_count());
  fill_pressure_recovery(boundary, *body.space, pairs);
  return boundary;
}

}  // namespace ricochet
