#include "ricochet/contact/mortar/pair_nodes.hpp"

#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Weights of the multipliers, per node.
using PressureRows = std::map<Index, std::map<int, double>>;

/// Computes rows of nodes between vertices of the opposite facets: the mean of those vertices that have a pressure.
PressureRows rows_between_vertices(const PairedSurfaces& surfaces, const PressureRows& rows) {
  PressureRows middles;
  const DisplacementSpace& space = *surfaces.body.space;
  for (const FacetSurface::Facet& facet : surfaces.opposite.facets()) {
    const IndexInBlocks location = locate_facet(space, facet.number);
    const CellBlock& block = space.facets[location.block];
    const auto& vertices_of = node_vertices(block.shape, space.degree);
    for (std::size_t k = 0; k < vertices_of.size(); ++k) {
      const Index node = block.cell(location.local)[k];
      if (vertices_of[k].size() == 1 || middles.contains(node)) continue;
      std::vector<const std::map<int, double>*> vertex_rows;
      for (const int v : vertices_of[k]) {
        const auto row = rows.find(block.cell(location.local)[v]);
        if (row != rows.end()) vertex_rows.push_back(&row->second);
      }
      for (const auto* row : vertex_rows) {
        for (const auto& [number, value] : *row) middles[node][number] += value / double(vertex_rows.size());
      }
    }
  }
  return middles;
}

/// Adds nodes around which no facet faces the other side, with all facets around them.
std::map<Index, AreaSum> with_others(std::map<Index, AreaSum> facing, const PairedSurfaces& surfaces,
                                     const FacetSurface& surface) {
  facing.merge(areas_around_nodes(surfaces.body, surface));
  return facing;
}

}  // namespace

std::map<Index, AreaSum> areas_around_faced_nodes(const PairedSurfaces& surfaces,
                                                  const std::vector<FacetSegments>& direct) {
  std::set<Index> faced;
  for (const FacetSegments& segments : direct) {
    for (const SurfaceSegment& segment : segments.segments) faced.insert(segment.opposite);
  }
  return areas_around_nodes(surfaces.body, surfaces.opposite, &faced);
}

std::vector<BodyContact::Node> nodes_of_points(const PairedSurfaces& surfaces, const std::vector<FacetSegments>& direct,
                                               const AnchorDirections& directions, const BodyContact& contact) {
  std::set<Index> own_nodes, opposite_nodes;
  for (std::size_t i = 0; i < contact.multipliers.size(); ++i) {
    for (const auto& [node, weight] : contact.multipliers[i].trace) own_nodes.insert(node);
    for (const auto& [node, weight] : contact.conditions[i].opposite) opposite_nodes.insert(node);
  }
  std::set<Index> facing;
  for (std::size_t k = 0; k < direct.size(); ++k) {
    if (!direct[k].segments.empty()) facing.insert(surfaces.own.facets()[k].number);
  }
  const std::map<Index, AreaSum> own_areas =
      with_others(areas_around_nodes(surfaces.body, surfaces.own, &facing), surfaces, surfaces.own);
  const std::map<Index, AreaSum> opposite_areas =
      with_others(areas_around_faced_nodes(surfaces, direct), surfaces, surfaces.opposite);
  std::vector<BodyContact::Node> result;
  for (const Index node : own_nodes) {
    const auto found = directions.find(node);
    const Eigen::Vector3d direction =
        found != directions.end() ? found->second : Eigen::Vector3d(-own_areas.at(node).vector.normalized());
    result.push_back(surfaces.node_facing(node, true, direction));
  }
  for (const Index node : opposite_nodes)
    result.push_back(surfaces.node_facing(node, false, -opposite_areas.at(node).vector.normalized()));
  return result;
}

std::vector<Eigen::Triplet<double>> opposite_pressure(const PairedSurfaces& surfaces,
                                                      const std::vector<FacetSegments>& direct,
                                                      const MultiplierSpace& space,
                                                      const std::vector<Multiplier>& multipliers) {
  PressureRows own_rows, rows;
  for (const auto& entry : space.pressure_recovery(multipliers)) own_rows[entry.row()][entry.col()] += entry.value();
  PressureTransfer transfer(surfaces.body, surfaces.map);
  for (std::size_t k = 0; k < direct.size(); ++k) transfer.add_facet(surfaces.own.facets()[k].number, direct[k]);
  for (const auto& [vertex, weights] : transfer.weights()) {
    for (const auto& [own_vertex, weight] : weights) {
      const auto row = own_rows.find(own_vertex);
      if (row == own_rows.end()) continue;
      for (const auto& [number, value] : row->second) rows[vertex][number] += weight * value;
    }
  }
  rows.merge(rows_between_vertices(surfaces, rows));
  std::vector<Eigen::Triplet<double>> result;
  for (const auto& [node, row] : rows) {
    for (const auto& [number, value] : row) result.emplace_back(int(node), number, value);
  }
  return result;
}

}  // namespace ricochet
