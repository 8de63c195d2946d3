#include "ricochet/report/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/mesh/flat_pieces.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/report/node_grid.hpp"

namespace ricochet {

namespace {

struct Triangle {
  std::array<Index, 3> corners;
  Index cell;
  int edges;
};

/// A flat piece of a facet (or of a plane cell), in the local nodes of the element.
struct FacetPattern {
  FlatPiece corners;
  int edges;
};

/// Returns which sides lie on edges of the cell: those with both nodes on the edge.
int edges_of(CellShape shape, int degree, const FlatPiece& corners) {
  int edges = 0;
  for (const std::vector<int>& edge : facet_nodes(shape, degree)) {
    const auto contains = [&edge](int node) { return std::find(edge.begin(), edge.end(), node) != edge.end(); };
    for (std::size_t k = 0; k < 3; ++k) {
      if (contains(corners[k]) && contains(corners[(k + 1) % 3])) edges |= 1 << k;
    }
  }
  return edges;
}

std::vector<FacetPattern> facet_patterns(CellShape shape, int degree) {
  std::vector<FacetPattern> result;
  for (const FlatPiece& corners : flat_pieces(shape, degree))
    result.push_back({corners, edges_of(shape, degree, corners)});
  return result;
}

std::vector<Triangle> plane_triangles(const std::vector<CellBlock>& blocks) {
  std::vector<Triangle> result;
  Index number = 0;
  for (const CellBlock& block : blocks) {
    const std::vector<FacetPattern> patterns =
        facet_patterns(block.shape, degree_of(block.shape, block.nodes_per_cell));
    for (Index i = 0; i < block.size(); ++i, ++number) {
      const Index* cell = block.cell(i);
      for (const auto& [corners, edges] : patterns)
        result.push_back({{cell[corners[0]], cell[corners[1]], cell[corners[2]]}, number, edges});
    }
  }
  return result;
}

std::vector<Triangle> boundary_triangles(const std::vector<CellBlock>& blocks) {
  std::vector<Index> first_cell{0};
  std::map<CellShape, std::vector<FacetPattern>> patterns;
  for (const CellBlock& block : blocks) {
    first_cell.push_back(first_cell.back() + block.size());
    for (const CellShape shape : cell_shapes()) {
      if (dimension(shape) == 2) patterns[shape] = facet_patterns(shape, degree_of(block.shape, block.nodes_per_cell));
    }
  }
  std::vector<Triangle> result;
  for (const CellFacet& facet : boundary_facets(blocks)) {
    const std::vector<Index> nodes = nodes_of_facet(blocks, facet);
    for (const auto& [corners, edges] : patterns.at(facet_shape(blocks[facet.block].shape, facet.local))) {
      const auto corner = [&, &corners = corners](std::size_t k) {
        return nodes[static_cast<std::size_t>(corners[k])];
      };
      result.push_back({{corner(0), corner(1), corner(2)}, first_cell[facet.block] + facet.cell, edges});
    }
  }
  return result;
}

std::vector<Index> used_nodes(const std::vector<Triangle>& triangles) {
  std::vector<Index> all;
  all.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) all.insert(all.end(), t.corners.begin(), t.corners.end());
  return sorted_unique(std::move(all));
}

/// Merges all nodes of a box into the first of them. Degenerate and repeated triangles are left out.
std::vector<Triangle> merged(const Points& nodes, const std::vector<Triangle>& triangles, double boxes) {
  const NodeGrid grid(nodes, boxes);
  std::map<std::array<std::uint32_t, 3>, Index> first;
  std::vector<Index> representative(static_cast<std::size_t>(nodes.cols()), -1);
  for (const Index node : used_nodes(triangles))
    representative[static_cast<std::size_t>(node)] = first.try_emplace(grid.box(nodes, node), node).first->second;
  std::vector<Triangle> result;
  std::map<std::array<Index, 3>, bool> added;
  for (Triangle t : triangles) {
    for (Index& corner : t.corners) corner = representative[static_cast<std::size_t>(corner)];
    std::array<Index, 3> key = t.corners;
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2] || !added.try_emplace(key, true).second) continue;
    t.edges = 0b111;
    result.push_back(t);
  }
  return result;
}

}  // namespace

Surface make_surface(const Points& nodes, const std::vector<CellBlock>& cells, Index most) {
  const bool plane = dimension(cells.front().shape) == 2;
  std::vector<Triangle> triangles = plane ? plane_triangles(cells) : boundary_triangles(cells);
  Surface surface;
  if (static_cast<Index>(triangles.size()) > most) {
    surface.is_thinned = true;
    const std::vector<Triangle> all = std::move(triangles);
    // The number of triangles grows with the square of the boxes along a side; a slender body has fewer.
    double boxes = 16.0 * std::sqrt(static_cast<double>(most));
    do {
      triangles = merged(nodes, all, boxes);
      boxes *= 0.75;
    } while (static_cast<Index>(triangles.size()) > most);
  }
  surface.nodes = spatially_sorted(nodes, used_nodes(triangles));
  const std::vector<int> local = local_numbers(surface.nodes, nodes.cols());
  // Triangles with close nodes become neighbours in the list.
  const auto first_of = [&local](const Triangle& t) {
    const auto number = [&local](Index node) { return local[static_cast<std::size_t>(node)]; };
    return std::tuple(std::min({number(t.corners[0]), number(t.corners[1]), number(t.corners[2])}), t.cell);
  };
  std::stable_sort(triangles.begin(), triangles.end(),
                   [&](const Triangle& a, const Triangle& b) { return first_of(a) < first_of(b); });
  for (const Triangle& t : triangles) {
    for (const Index corner : t.corners) surface.triangles.push_back(local[static_cast<std::size_t>(corner)]);
    surface.cells.push_back(static_cast<int>(t.cell));
    surface.edges.push_back(t.edges);
  }
  return surface;
}

}  // namespace ricochet
