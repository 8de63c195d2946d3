#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/construction/boundary_patch.hpp"
#include "ricochet/contact/mortar/paired_surfaces.hpp"
#include "ricochet/contact/rotating_pairs.hpp"

namespace ricochet {

namespace {

using Patches = std::vector<std::unique_ptr<BoundaryPatch>>;

/// Marks the nodes on whose displacement a row of a contact point may depend: those in some trace, which have no
/// inertia if contact nodes have none.
std::vector<char> reached_by_traces(const Body& body, const Patches& patches) {
  std::vector<char> result(static_cast<std::size_t>(body.space->node_count()), 0);
  const auto mark = [&result](const TiedNodes::Weights& weights) {
    for (const auto& [node, weight] : weights) result[std::size_t(node)] = 1;
  };
  for (const auto& patch : patches) {
    for (const TiedNodes::Weights& trace : patch->free_traces) mark(trace);
    for (const PointConditions& conditions : patch->conditions) mark(conditions.opposite);
  }
  return result;
}

/// Returns the facets of which every node is marked.
std::vector<Index> of_marked_nodes(const DisplacementSpace& space, const std::vector<Index>& facets,
                                   const std::vector<char>& marked) {
  std::vector<Index> result;
  for (const Index facet : facets) {
    const std::vector<Index> nodes = facet_nodes(space, {facet});
    if (std::ranges::all_of(nodes, [&](Index node) { return marked[std::size_t(node)] != 0; })) result.push_back(facet);
  }
  return result;
}

std::vector<Index> around(const FacetsAround& facets, Index node) {
  const auto found = facets.find(node);
  return found != facets.end() ? found->second : std::vector<Index>{};
}

/// Returns the facets of the other side in the trace of a multiplier.
std::vector<Index> facets_in_trace(const FacetsAround& facets, const TiedNodes::Weights& trace) {
  std::vector<Index> result;
  for (const auto& [node, weight] : trace) {
    if (weight == 0.0) continue;
    const std::vector<Index> here = around(facets, node);
    result.insert(result.end(), here.begin(), here.end());
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

double gap_at_start(const Body& body, const Vector& normal, const TiedNodes::Weights& own,
                    const TiedNodes::Weights& opposite) {
  double gap = 0.0;
  for (const auto& [node, weight] : own) gap += weight * normal.dot(body.space->nodes.col(node));
  for (const auto& [node, weight] : opposite) gap -= weight * normal.dot(body.space->nodes.col(node));
  return gap;
}

RotatingPairsData::Point rotating_point(const Body& body, const BoundaryPatch& patch, std::size_t index,
                                        const FreeComponent& is_free) {
  const PointConditions& conditions = patch.conditions[index];
  RotatingPairsData::Point point{.number = patch.numbers[index], .normal = patch.rotating_normals[index]};
  point.offset = conditions.gap - gap_at_start(body, conditions.normal, patch.free_traces[index], conditions.opposite);
  const int d = body.space->dimension;
  const Index freest = freest_node(patch, index, d, is_free);
  for (int k = 0; k < d; ++k) point.is_free[std::size_t(k)] = is_free(freest, k);
  point.nodes = point.normal.nodes();
  for (const auto* const weights : {&patch.free_traces[index], &conditions.opposite}) {
    for (const auto& [node, weight] : *weights) point.nodes.push_back(node);
  }
  std::ranges::sort(point.nodes);
  point.nodes.erase(std::unique(point.nodes.begin(), point.nodes.end()), point.nodes.end());
  return point;
}

/// Adds nodes of the nodal output, which rotate with the facets around them.
void add_nodes(const Body& body, const std::vector<ContactPair>& pairs, const ContactBoundary& boundary,
               RotatingPairsData& data) {
  std::map<std::pair<int, bool>, FacetsAround> around_nodes;
  for (std::size_t i = 0; i < boundary.nodes.size(); ++i) {
    const int number = boundary.node_pair[i];
    const ContactPair& pair = pairs[std::size_t(number)];
    if (!pair.has_two_sides() || pair.large_sliding || std::isnan(boundary.node_initial_gap[Index(i)])) continue;
    const bool opposite = boundary.is_opposite[i] != 0;
    auto found = around_nodes.find({number, opposite});
    if (found == around_nodes.end()) {
      const auto& facets = opposite ? pair.opposite_facets : pair.facets;
      found = around_nodes.emplace(std::pair{number, opposite}, facets_around_nodes(*body.space, facets)).first;
    }
    const auto entry = Index(i);
    const Index node = boundary.nodes[i];
    const Vector normal = boundary.node_normals.col(entry);
    TiedNodes::Weights projection;
    for (SparseRowMatrix::InnerIterator at(boundary.opposite_projection, entry); at; ++at)
      projection.emplace_back(at.col(), at.value());
    const double offset = boundary.node_initial_gap[entry] - gap_at_start(body, normal, {{node, 1.0}}, projection);
    data.nodes.push_back({entry, node, RotatingNormal(*body.space, around(found->second, node), normal), offset});
  }
}

}  // namespace

void find_rotating_normals(const Body& body, const std::vector<ContactPair>& pairs, const Patches& patches) {
  std::vector<char> marked = reached_by_traces(body, patches);
  if (body.tied != nullptr) {
    for (const TiedNodes::Tie& tie : body.tied->ties()) marked[std::size_t(tie.node)] = 0;
  }
  for (const auto& patch : patches) {
    if (patch->obstacle != nullptr || patch->slides) continue;
    const ContactPair& pair = pairs[std::size_t(patch->first_pair())];
    const FacetsAround own =
        facets_around_nodes(*body.space, of_marked_nodes(*body.space, patch->facets.parts.front().facets, marked));
    const FacetsAround opposite =
        facets_around_nodes(*body.space, of_marked_nodes(*body.space, pair.opposite_facets, marked));
    Index constant = 0;
    for (std::size_t i = 0; i < patch->retained.size(); ++i) {
      const Multiplier& multiplier = patch->retained[i];
      const Vector& normal = patch->conditions[i].normal;
      if (multiplier.node >= 0 && is_on_axis(body, multiplier.node)) {
        patch->rotating_normals.emplace_back(normal);
        continue;
      }
      const std::vector<Index> facets =
          multiplier.facet >= 0 ? std::vector{multiplier.facet} : around(own, multiplier.node);
      RotatingNormal rotating_normals = RotatingNormal::mean(
          RotatingNormal(*body.space, of_marked_nodes(*body.space, facets, marked), normal),
          RotatingNormal(*body.space, facets_in_trace(opposite, patch->conditions[i].opposite), normal));
      if (!rotating_normals.rotates()) ++constant;
      patch->rotating_normals.push_back(std::move(rotating_normals));
    }
    if (constant == 0) continue;
    log::warning(fmt::format(
        "contact of \"{}\" and \"{}\": {} the initial direction while bodies rotate, as no facet around them has only "
        "contact nodes",
        pair.first_group(), pair.second_group(), counted(constant, "contact point keeps", "contact points keep")));
  }
}

std::unique_ptr<ContactGeometry> make_rotating_geometry(const Body& body, const std::vector<ContactPair>& pairs,
                                                        const Patches& patches, const FreeComponent& is_free,
                                                        const ContactBoundary& boundary) {
  RotatingPairsData data;
  for (const auto& patch : patches) {
    if (patch->rotating_normals.empty() || patch->slides) continue;
    for (std::size_t i = 0; i < patch->retained.size(); ++i)
      data.points.push_back(rotating_point(body, *patch, i, is_free));
  }
  if (data.points.empty()) return nullptr;
  add_nodes(body, pairs, boundary, data);
  data.node_positions = body.space->nodes;
  data.node_normals = boundary.node_normals;
  data.trace = boundary.trace;
  data.opposite_projection = boundary.opposite_projection;
  return make_rotating_pairs(std::move(data));
}

}  // namespace ricochet
