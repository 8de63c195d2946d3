#include "ricochet/report/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/report/node_grid.hpp"

namespace ricochet {

namespace {

struct Triangle {
  std::array<Index, 3> corners;
  Index cell;
  int edges;
};

/// A flat piece of a facet (or of a plane cell), by the element's own nodes.
struct Pattern {
  std::array<int, 3> corners;
  int edges;
};

/// The element's node in the middle of these vertices.
int node_at(CellShape shape, std::vector<int> vertices) {
  const auto& all = node_vertices(shape, 2);
  return static_cast<int>(std::find(all.begin(), all.end(), vertices) - all.begin());
}

/// A triangle a b c, of degree 2 in four with its middles.
std::vector<Pattern> triangle_patterns(int degree) {
  if (degree == 1) return {{{0, 1, 2}, 0b111}};
  const int ab = node_at(CellShape::triangle, {0, 1}), bc = node_at(CellShape::triangle, {1, 2}),
            ca = node_at(CellShape::triangle, {0, 2});
  return {{{0, ab, ca}, 0b101}, {{ab, 1, bc}, 0b011}, {{ca, bc, 2}, 0b110}, {{ab, bc, ca}, 0b000}};
}

/// A quadrilateral with the corners a b c d around it, in two triangles a b c and a c d; of degree 2 four such.
std::vector<Pattern> quadrilateral_patterns(int degree) {
  if (degree == 1) return {{{0, 1, 3}, 0b011}, {{0, 3, 2}, 0b110}};
  const CellShape shape = CellShape::quadrilateral;
  const int ab = node_at(shape, {0, 1}), ad = node_at(shape, {0, 2}), bc = node_at(shape, {1, 3}),
            dc = node_at(shape, {2, 3}), middle = node_at(shape, {0, 1, 2, 3});
  // Each quarter from its corner: the two sides that meet there are edges of the cell.
  return {{{0, ab, middle}, 0b001}, {{0, middle, ad}, 0b100}, {{1, bc, middle}, 0b001}, {{1, middle, ab}, 0b100},
          {{3, dc, middle}, 0b001}, {{3, middle, bc}, 0b100}, {{2, ad, middle}, 0b001}, {{2, middle, dc}, 0b100}};
}

std::vector<Pattern> patterns_of(CellShape shape, int degree) {
  return shape == CellShape::triangle ? triangle_patterns(degree) : quadrilateral_patterns(degree);
}

int degree_of(const CellBlock& block) {
  return block.nodes_per_cell == node_count(block.shape, 1) ? 1 : 2;
}

std::vector<Triangle> plane_triangles(const std::vector<CellBlock>& blocks) {
  std::vector<Triangle> result;
  Index number = 0;
  for (const CellBlock& block : blocks) {
    const std::vector<Pattern> patterns = patterns_of(block.shape, degree_of(block));
    for (Index i = 0; i < block.size(); ++i, ++number) {
      const Index* cell = block.cell(i);
      for (const Pattern& p : patterns)
        result.push_back({{cell[p.corners[0]], cell[p.corners[1]], cell[p.corners[2]]}, number, p.edges});
    }
  }
  return result;
}

/// A facet by its vertices, ascending (−1 in front of three), and where it is.
struct Facet {
  std::array<Index, 4> vertices;
  Index cell;  ///< through all blocks
  int block, local;
};

std::vector<Facet> all_facets(const std::vector<CellBlock>& blocks) {
  std::vector<Facet> result;
  Index number = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const CellBlock& block = blocks[b];
    const auto& corners = facet_nodes(block.shape, 1);
    for (Index i = 0; i < block.size(); ++i, ++number) {
      for (std::size_t f = 0; f < corners.size(); ++f) {
        Facet facet{{-1, -1, -1, -1}, number, static_cast<int>(b), static_cast<int>(f)};
        for (std::size_t k = 0; k < corners[f].size(); ++k) facet.vertices[k] = block.cell(i)[corners[f][k]];
        std::sort(facet.vertices.begin(), facet.vertices.end());
        result.push_back(facet);
      }
    }
  }
  return result;
}

/// The facets that belong to one cell alone.
std::vector<Triangle> boundary_triangles(const std::vector<CellBlock>& blocks) {
  std::vector<Facet> facets = all_facets(blocks);
  std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
    return std::tie(a.vertices, a.cell, a.local) < std::tie(b.vertices, b.cell, b.local);
  });
  std::vector<Index> first_cell{0};
  for (const CellBlock& block : blocks) first_cell.push_back(first_cell.back() + block.size());
  std::vector<Triangle> result;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const Facet& facet = facets[i];
    const bool shared = (i > 0 && facets[i - 1].vertices == facet.vertices) ||
                        (i + 1 < facets.size() && facets[i + 1].vertices == facet.vertices);
    if (shared) continue;
    const CellBlock& block = blocks[static_cast<std::size_t>(facet.block)];
    const int degree = degree_of(block);
    const Index* cell = block.cell(facet.cell - first_cell[static_cast<std::size_t>(facet.block)]);
    const std::vector<int>& nodes = facet_nodes(block.shape, degree)[static_cast<std::size_t>(facet.local)];
    for (const Pattern& p : patterns_of(facet_shape(block.shape), degree)) {
      const auto corner = [&](std::size_t k) { return cell[nodes[static_cast<std::size_t>(p.corners[k])]]; };
      result.push_back({{corner(0), corner(1), corner(2)}, facet.cell, p.edges});
    }
  }
  return result;
}

std::vector<Index> used_nodes(const std::vector<Triangle>& triangles) {
  std::vector<Index> all;
  all.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) all.insert(all.end(), t.corners.begin(), t.corners.end());
  return each_once(std::move(all));
}

/// One node for all of a box: the first of them. What is no triangle any more, or one that is there already, is left
/// out.
std::vector<Triangle> merged(const Points& nodes, const std::vector<Triangle>& triangles, double boxes) {
  const NodeGrid grid(nodes, boxes);
  std::map<std::array<std::uint32_t, 3>, Index> first;
  std::vector<Index> stands_for(static_cast<std::size_t>(nodes.cols()), -1);
  for (const Index node : used_nodes(triangles))
    stands_for[static_cast<std::size_t>(node)] = first.try_emplace(grid.box(nodes, node), node).first->second;
  std::vector<Triangle> result;
  std::map<std::array<Index, 3>, bool> seen;
  for (Triangle t : triangles) {
    for (Index& corner : t.corners) corner = stands_for[static_cast<std::size_t>(corner)];
    std::array<Index, 3> key = t.corners;
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2] || !seen.try_emplace(key, true).second) continue;
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
    // The number of triangles goes with the square of the boxes along a side; of a slender body there are fewer.
    double boxes = 16.0 * std::sqrt(static_cast<double>(most));
    do {
      triangles = merged(nodes, all, boxes);
      boxes *= 0.75;
    } while (static_cast<Index>(triangles.size()) > most);
  }
  surface.nodes = by_place(nodes, used_nodes(triangles));
  const std::vector<int> local = local_numbers(surface.nodes, nodes.cols());
  // Each triangle beside those with near nodes.
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
