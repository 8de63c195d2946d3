#include "ricochet/report/volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "ricochet/mesh/flat_pieces.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/report/node_grid.hpp"

namespace ricochet {

namespace {

/// A tetrahedron inside a cell, in the local nodes of the element.
struct CellPattern {
  FlatPiece corners;
  int faces;
};

struct Tetrahedron {
  std::array<Index, 4> corners;
  int cell, faces;
};

/// Returns which faces lie on facets of the cell: those with all three nodes on the facet.
int faces_of(CellShape shape, int degree, const FlatPiece& corners) {
  int faces = 0;
  for (const std::vector<int>& facet : facet_nodes(shape, degree)) {
    int inside = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (std::find(facet.begin(), facet.end(), corners[k]) != facet.end()) inside |= 1 << k;
    }
    for (int k = 0; k < 4; ++k) {
      if (inside == (0b1111 & ~(1 << k))) faces |= 1 << k;
    }
  }
  return faces;
}

std::vector<CellPattern> cell_patterns(CellShape shape, int degree) {
  std::vector<CellPattern> result;
  for (const FlatPiece& corners : flat_pieces(shape, degree))
    result.push_back({corners, faces_of(shape, degree, corners)});
  return result;
}

/// Returns the number of tetrahedra.
Index count_of(const std::vector<CellBlock>& blocks, int most_degree) {
  Index count = 0;
  for (const CellBlock& block : blocks) {
    const auto patterns =
        cell_patterns(block.shape, std::min(degree_of(block.shape, block.nodes_per_cell), most_degree));
    count += block.size() * static_cast<Index>(patterns.size());
  }
  return count;
}

std::vector<Tetrahedron> tetrahedra_of(const std::vector<CellBlock>& blocks, int most_degree) {
  std::vector<Tetrahedron> result;
  int number = 0;
  for (const CellBlock& block : blocks) {
    const std::vector<CellPattern> patterns =
        cell_patterns(block.shape, std::min(degree_of(block.shape, block.nodes_per_cell), most_degree));
    for (Index i = 0; i < block.size(); ++i, ++number) {
      const Index* cell = block.cell(i);
      for (const auto& [corners, faces] : patterns)
        result.push_back({{cell[corners[0]], cell[corners[1]], cell[corners[2]], cell[corners[3]]}, number, faces});
    }
  }
  return result;
}

std::vector<Index> used_nodes(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<Index> all;
  all.reserve(4 * tetrahedra.size());
  for (const Tetrahedron& t : tetrahedra) all.insert(all.end(), t.corners.begin(), t.corners.end());
  return sorted_unique(std::move(all));
}

/// Merges all nodes of a box into the first of them. Tetrahedra without volume are left out.
std::vector<Tetrahedron> merged(const Points& nodes, const std::vector<Tetrahedron>& tetrahedra, double boxes) {
  const NodeGrid grid(nodes, boxes);
  std::map<GridBox, Index> first;
  std::vector<Index> representative(static_cast<std::size_t>(nodes.cols()), -1);
  for (const Index node : used_nodes(tetrahedra))
    representative[static_cast<std::size_t>(node)] = first.try_emplace(grid.box(nodes, node), node).first->second;
  std::vector<Tetrahedron> result;
  for (Tetrahedron t : tetrahedra) {
    for (Index& corner : t.corners) corner = representative[static_cast<std::size_t>(corner)];
    std::array<Index, 4> key = t.corners;
    std::sort(key.begin(), key.end());
    if (std::adjacent_find(key.begin(), key.end()) != key.end()) continue;
    t.faces = 0b1111;
    result.push_back(t);
  }
  return result;
}

}  // namespace

Volume make_volume(const Points& nodes, const std::vector<CellBlock>& cells, Index most) {
  Volume volume;
  if (dimension(cells.front().shape) != 3) return volume;
  std::vector<Tetrahedron> tetrahedra = tetrahedra_of(cells, count_of(cells, 2) <= most ? 2 : 1);
  const auto too_many = [&] { return static_cast<Index>(tetrahedra.size()) > most; };
  if (too_many()) {
    volume.is_thinned = true;
    const std::vector<Tetrahedron> all = std::move(tetrahedra);
    // The number grows with the cube of the boxes along a side; a slender body has fewer.
    double boxes = 4.0 * std::cbrt(static_cast<double>(most));
    do {
      tetrahedra = merged(nodes, all, boxes);
      boxes *= 0.8;
    } while (too_many());
  }
  volume.nodes = spatially_sorted(nodes, used_nodes(tetrahedra));
  const std::vector<int> local = local_numbers(volume.nodes, nodes.cols());
  const auto first_of = [&local](const Tetrahedron& t) {
    int least = local[static_cast<std::size_t>(t.corners[0])];
    for (const Index corner : t.corners) least = std::min(least, local[static_cast<std::size_t>(corner)]);
    return std::pair(least, t.cell);
  };
  std::stable_sort(tetrahedra.begin(), tetrahedra.end(),
                   [&](const Tetrahedron& a, const Tetrahedron& b) { return first_of(a) < first_of(b); });
  for (const Tetrahedron& t : tetrahedra) {
    for (const Index corner : t.corners) volume.tetrahedra.push_back(local[static_cast<std::size_t>(corner)]);
    volume.cells.push_back(t.cell);
    volume.faces.push_back(t.faces);
  }
  return volume;
}

}  // namespace ricochet
