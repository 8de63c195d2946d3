#include "ricochet/report/simplices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/mesh/flat_pieces.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/report/node_grid.hpp"

namespace ricochet {

namespace {

/// A triangle or tetrahedron of the body.
template <std::size_t count>
struct Simplex {
  std::array<Index, count> corners;
  Index cell;
  int sides;
};

/// A flat piece of a cell (or of a facet of it), in the local nodes of the element.
struct SimplexPattern {
  FlatPiece corners;
  int sides;
};

/// Returns which sides lie on sides of the cell: those with all their nodes on it.
template <std::size_t count>
int sides_of(const std::vector<std::vector<int>>& facets, const FlatPiece& corners) {
  int sides = 0;
  for (const std::vector<int>& facet : facets) {
    const auto contains = [&](std::size_t k) { return std::ranges::find(facet, corners[k]) != facet.end(); };
    for (std::size_t k = 0; k < count; ++k) {
      bool all = true;
      for (std::size_t i = 0; i < count; ++i) {
        const bool is_of_side = count == 3 ? i == k || i == (k + 1) % count : i != k;
        all = all && (!is_of_side || contains(i));
      }
      if (all) sides |= 1 << k;
    }
  }
  return sides;
}

template <std::size_t count>
std::vector<SimplexPattern> patterns_of(CellShape shape, int degree) {
  std::vector<SimplexPattern> result;
  for (const FlatPiece& corners : flat_pieces(shape, degree))
    result.push_back({corners, sides_of<count>(facet_nodes(shape, degree), corners)});
  return result;
}

template <std::size_t count>
void append(const Index* nodes, Index cell, const std::vector<SimplexPattern>& patterns,
            std::vector<Simplex<count>>& simplices) {
  for (const auto& [corners, sides] : patterns) {
    Simplex<count>& simplex = simplices.emplace_back(Simplex<count>{{}, cell, sides});
    for (std::size_t k = 0; k < count; ++k) simplex.corners[k] = nodes[corners[k]];
  }
}

template <std::size_t count>
std::vector<Simplex<count>> simplices_of_cells(const std::vector<CellBlock>& blocks, int most_degree) {
  std::vector<Simplex<count>> result;
  Index number = 0;
  for (const CellBlock& block : blocks) {
    const std::vector<SimplexPattern> patterns =
        patterns_of<count>(block.shape, std::min(degree_of(block.shape, block.nodes_per_cell), most_degree));
    for (Index i = 0; i < block.size(); ++i, ++number) append(block.cell(i), number, patterns, result);
  }
  return result;
}

std::vector<Simplex<3>> boundary_triangles(const std::vector<CellBlock>& blocks) {
  std::vector<Index> first_cell{0};
  std::map<CellShape, std::vector<SimplexPattern>> patterns;
  for (const CellBlock& block : blocks) {
    first_cell.push_back(first_cell.back() + block.size());
    for (const CellShape shape : cell_shapes()) {
      if (dimension(shape) == 2) patterns[shape] = patterns_of<3>(shape, degree_of(block.shape, block.nodes_per_cell));
    }
  }
  std::vector<Simplex<3>> result;
  for (const CellFacet& facet : boundary_facets(blocks))
    append(nodes_of_facet(blocks, facet).data(), first_cell[facet.block] + facet.cell,
           patterns.at(facet_shape(blocks[facet.block].shape, facet.local)), result);
  return result;
}

template <std::size_t count>
std::vector<Index> used_nodes(const std::vector<Simplex<count>>& simplices) {
  std::vector<Index> all;
  all.reserve(count * simplices.size());
  for (const Simplex<count>& s : simplices) all.insert(all.end(), s.corners.begin(), s.corners.end());
  return sorted_unique(std::move(all));
}

/// Merges all nodes of a box into the first of them. Simplices without volume and repeated triangles are left out.
template <std::size_t count>
std::vector<Simplex<count>> merged(const Points& nodes, const std::vector<Simplex<count>>& simplices, double boxes) {
  const NodeGrid grid(nodes, boxes);
  std::map<GridBox, Index> first;
  std::vector<Index> representative(static_cast<std::size_t>(nodes.cols()), -1);
  for (const Index node : used_nodes(simplices))
    representative[std::size_t(node)] = first.try_emplace(grid.box(nodes, node), node).first->second;
  std::vector<Simplex<count>> result;
  std::set<std::array<Index, count>> added;
  for (Simplex<count> simplex : simplices) {
    for (Index& corner : simplex.corners) corner = representative[std::size_t(corner)];
    std::array<Index, count> key = simplex.corners;
    std::ranges::sort(key);
    if (std::adjacent_find(key.begin(), key.end()) != key.end()) continue;
    if (count == 3 && !added.insert(key).second) continue;
    simplex.sides = (1 << count) - 1;
    result.push_back(simplex);
  }
  return result;
}

/// Merges nodes while there are more simplices than `most`, in so many boxes at first; then sorts and numbers them.
template <std::size_t count>
Simplices drawn(const Points& nodes, std::vector<Simplex<count>> simplices, Index most, double boxes, double fewer) {
  Simplices result;
  const auto too_many = [&] { return Index(simplices.size()) > most; };
  result.is_thinned = too_many();
  for (const std::vector<Simplex<count>> all = too_many() ? simplices : std::vector<Simplex<count>>{}; too_many();
       boxes *= fewer)
    simplices = merged(nodes, all, boxes);
  result.nodes = spatially_sorted(nodes, used_nodes(simplices));
  const std::vector<int> local = local_numbers(result.nodes, nodes.cols());
  const auto number = [&local](Index node) { return local[std::size_t(node)]; };
  // Simplices with close nodes become neighbours in the list.
  const auto first_of = [&](const Simplex<count>& simplex) {
    int least = number(simplex.corners[0]);
    for (const Index corner : simplex.corners) least = std::min(least, number(corner));
    return std::pair(least, simplex.cell);
  };
  std::ranges::stable_sort(simplices, [&](const auto& a, const auto& b) { return first_of(a) < first_of(b); });
  for (const Simplex<count>& simplex : simplices) {
    for (const Index corner : simplex.corners) result.corners.push_back(number(corner));
    result.cells.push_back(int(simplex.cell));
    result.sides.push_back(simplex.sides);
  }
  return result;
}

}  // namespace

/// The number of triangles grows with the square of the boxes along a side; a slender body has fewer.
Simplices make_surface(const Points& nodes, const std::vector<CellBlock>& cells, Index most) {
  const bool plane = dimension(cells.front().shape) == 2;
  return drawn(nodes, plane ? simplices_of_cells<3>(cells, 2) : boundary_triangles(cells), most,
               16.0 * std::sqrt(double(most)), 0.75);
}

/// The number of tetrahedra grows with the cube.
Simplices make_volume(const Points& nodes, const std::vector<CellBlock>& cells, Index most) {
  if (dimension(cells.front().shape) != 3) return {};
  Index count = 0;
  for (const CellBlock& block : cells)
    count += block.size() * Index(flat_pieces(block.shape, degree_of(block.shape, block.nodes_per_cell)).size());
  return drawn(nodes, simplices_of_cells<4>(cells, count <= most ? 2 : 1), most, 4.0 * std::cbrt(double(most)), 0.8);
}

}  // namespace ricochet
