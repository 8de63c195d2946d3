#include "ricochet/mesh/refine_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/base/memory.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/vertex_set_table.hpp"

namespace ricochet {

namespace {

using VertexSet = std::vector<int>;    ///< of the parent cell: a point at their mean
using Child = std::vector<VertexSet>;  ///< its vertices
using Children = std::vector<Child>;

bool is_tensor(CellShape shape) {
  return shape == CellShape::quadrilateral || shape == CellShape::hexahedron || shape == CellShape::interval;
}

/// Children in lexicographic order, the order of all numberings on these cells.
Children children_of_tensor(CellShape shape) {
  const int d = dimension(shape), corners = 1 << d;
  Children result;
  for (int child = 0; child < corners; ++child) {
    Child& vertices = result.emplace_back();
    for (int vertex = 0; vertex < corners; ++vertex) {
      VertexSet& mean = vertices.emplace_back();
      for (int of_parent = 0; of_parent < corners; ++of_parent) {
        bool is_included = true;
        for (int axis = 0; axis < d; ++axis) {
          const int position = (child >> axis & 1) + (vertex >> axis & 1);  // 0, 1 or 2 halves of the edge
          is_included = is_included && (position == 1 || position == 2 * (of_parent >> axis & 1));
        }
        if (is_included) mean.push_back(of_parent);
      }
    }
  }
  return result;
}

VertexSet pair_of(int one, int other) {
  if (one == other) return {one};
  return {std::min(one, other), std::max(one, other)};
}

/// Children at the corners: copies of the parent at half its size.
Children corners_of_simplex(int d) {
  Children result;
  for (int corner = 0; corner <= d; ++corner) {
    Child& vertices = result.emplace_back();
    for (int vertex = 0; vertex <= d; ++vertex) vertices.push_back(pair_of(corner, vertex));
  }
  return result;
}

Eigen::Vector3d reference_position(CellShape shape, const VertexSet& mean) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int vertex : mean) {
    for (int axis = 0; axis < dimension(shape); ++axis) sum[axis] += vertex_coordinate(shape, vertex, axis);
  }
  return sum / static_cast<double>(mean.size());
}

constexpr std::array<std::array<int, 4>, 3> diagonals{{{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}}};

/// Cuts the octahedron that remains between the corners of a tetrahedron into four tetrahedra around the diagonal from
/// the midpoint of ab to that of cd.
Children around_diagonal(const std::array<int, 4>& abcd) {
  const auto [a, b, c, d] = abcd;
  const std::array<VertexSet, 4> ring{pair_of(a, c), pair_of(b, c), pair_of(b, d), pair_of(a, d)};
  Children result;
  for (std::size_t i = 0; i < 4; ++i) {
    Child child{pair_of(a, b), pair_of(c, d), ring[i], ring[(i + 1) % 4]};
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.col(k) = reference_position(CellShape::tetrahedron, child[static_cast<std::size_t>(k) + 1]) -
                     reference_position(CellShape::tetrahedron, child[0]);
    if (edges.determinant() < 0.0) std::swap(child[2], child[3]);
    result.push_back(std::move(child));
  }
  return result;
}

/// Alternative subdivisions of a shape, one per diagonal if there are several.
std::vector<Children> ways_to_cut(CellShape shape) {
  if (is_tensor(shape)) return {children_of_tensor(shape)};
  Children corners = corners_of_simplex(dimension(shape));
  if (shape == CellShape::triangle) {
    corners.push_back({{1, 2}, {0, 2}, {0, 1}});
    return {corners};
  }
  std::vector<Children> result;
  for (const auto& diagonal : diagonals) {
    result.push_back(corners);
    for (Child& child : around_diagonal(diagonal)) result.back().push_back(std::move(child));
  }
  return result;
}

/// Lagrange function of degree 2, at a reference point, of the node at the mean of some vertices.
double quadratic_function(CellShape shape, const VertexSet& node, const Eigen::Vector3d& at) {
  double result = 1.0;
  if (is_tensor(shape)) {
    for (int axis = 0; axis < dimension(shape); ++axis) {
      const double t = at[axis], coordinate = 2.0 * reference_position(shape, node)[axis];
      result *= coordinate == 0.0   ? (1.0 - t) * (1.0 - 2.0 * t)
                : coordinate == 1.0 ? 4.0 * t * (1.0 - t)
                                    : t * (2.0 * t - 1.0);
    }
    return result;
  }
  for (const int vertex : node) {
    const double share = vertex == 0 ? 1.0 - at.sum() : at[vertex - 1];
    result *= node.size() == 1 ? share * (2.0 * share - 1.0) : share;
  }
  return node.size() == 1 ? result : 4.0 * result;
}

/// Upper bounds of the numbers of new nodes on edges, in quadrilaterals and in hexahedra.
struct Bounds {
  std::size_t edges = 0, faces = 0, middles = 0;
};

/// New nodes, each created once for all cells that need it.
class NewNodes {
 public:
  NewNodes(Mesh& mesh, const Bounds& most)
      : mesh_(mesh), node_tables_{table(2, most.edges), table(4, most.faces), table(8, most.middles)} {}

  /// Returns the node at the mean of some vertices of the mesh; if missing, creates it at position().
  template <class Position>
  Index at_mean(const std::vector<Index>& vertices, const Position& position) {
    if (vertices.size() == 1) return vertices.front();
    const std::size_t kind = vertices.size() == 2 ? 0 : vertices.size() == 4 ? 1 : 2;
    NodeTable& entry = node_tables_[kind];
    const Index found = entry.table.find_or_add(vertices.data());
    if (found >= 0) return entry.nodes[static_cast<std::size_t>(found)];
    positions_.push_back(position());
    entry.nodes.push_back(mesh_.node_count() + static_cast<Index>(positions_.size()) - 1);
    return entry.nodes.back();
  }
  /// Position of a node of the mesh or of a new one.
  [[nodiscard]] Eigen::Vector3d position_of(Index node) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    if (node >= mesh_.node_count()) return positions_[static_cast<std::size_t>(node - mesh_.node_count())];
    result.head(mesh_.dimension) = mesh_.nodes.col(node);
    return result;
  }
  /// Adds the new nodes to the mesh.
  void add() {
    const Index before = mesh_.node_count();
    mesh_.nodes.conservativeResize(Eigen::NoChange, before + static_cast<Index>(positions_.size()));
    for (std::size_t i = 0; i < positions_.size(); ++i)
      mesh_.nodes.col(before + static_cast<Index>(i)) = positions_[i].head(mesh_.dimension);
    mesh_.node_tags.resize(static_cast<std::size_t>(mesh_.nodes.cols()), 0);
  }

 private:
  struct NodeTable {
    VertexSetTable table;
    std::vector<Index> nodes;
  };
  static NodeTable table(int vertices, std::size_t most) { return {VertexSetTable(vertices, most), {}}; }

  Mesh& mesh_;
  std::array<NodeTable, 3> node_tables_;
  std::vector<Eigen::Vector3d> positions_;
};

/// Cuts the elements of a mesh into parts, one shape after another.
class Cutter {
 public:
  Cutter(const Mesh& mesh, NewNodes& nodes) : mesh_(mesh), nodes_(nodes) {}

  CellBlock cut(const CellBlock& block) {
    shape_ = block.shape;
    const std::vector<Children> ways = ways_to_cut(shape_);
    CellBlock result{block.shape, block.nodes_per_cell, {}, {}};
    for (Index cell = 0; cell < block.size(); ++cell) {
      cell_ = block.cell(cell);
      for (const Child& child : ways[ways.size() == 1 ? 0 : shortest_diagonal()]) {
        add_nodes(child, result.nodes);
        result.tags.push_back(block.tags[static_cast<std::size_t>(cell)]);
      }
    }
    return result;
  }

 private:
  std::size_t shortest_diagonal() {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < diagonals.size(); ++i) {
      const auto [a, b, c, d] = diagonals[i];
      const double length =
          (nodes_.position_of(node_at(pair_of(a, b))) - nodes_.position_of(node_at(pair_of(c, d)))).norm();
      // Of equal diagonals the first is chosen, independently of rounding.
      if (length < least * (1.0 - 1e-12)) {
        least = length;
        best = i;
      }
    }
    return best;
  }

  Index node_at(const VertexSet& mean) {
    if (mesh_.degree == 2) return cell_[node_at_mean(shape_, mean)];
    std::vector<Index> vertices;
    for (const int vertex : mean) vertices.push_back(cell_[vertex]);
    return nodes_.at_mean(vertices, [&] {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Index vertex : vertices) sum += nodes_.position_of(vertex);
      return Eigen::Vector3d(sum / static_cast<double>(vertices.size()));
    });
  }

  /// Position of a reference point on the second-order geometry.
  [[nodiscard]] Eigen::Vector3d position_in_cell(const Eigen::Vector3d& at) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    const std::vector<std::vector<int>>& nodes = node_vertices(shape_, 2);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      result += quadratic_function(shape_, nodes[i], at) * nodes_.position_of(cell_[i]);
    return result;
  }

  void add_nodes(const Child& child, std::vector<Index>& result) {
    std::vector<Index> vertices;
    for (const VertexSet& mean : child) vertices.push_back(node_at(mean));
    for (const std::vector<int>& local : node_vertices(shape_, mesh_.degree)) {
      std::vector<Index> of_mesh;
      Eigen::Vector3d at = Eigen::Vector3d::Zero();
      for (const int vertex : local) {
        of_mesh.push_back(vertices[static_cast<std::size_t>(vertex)]);
        at += reference_position(shape_, child[static_cast<std::size_t>(vertex)]);
      }
      result.push_back(
          nodes_.at_mean(of_mesh, [&] { return position_in_cell(at / static_cast<double>(local.size())); }));
    }
  }

  const Mesh& mesh_;
  NewNodes& nodes_;
  CellShape shape_ = CellShape::triangle;
  const Index* cell_ = nullptr;
};

Index parts_of(CellShape shape) {
  return Index{1} << dimension(shape);
}

/// Numbers, through all blocks, of the parts of some elements.
std::vector<Index> numbers_of_parts(const std::vector<CellBlock>& blocks, const std::vector<Index>& members) {
  std::vector<Index> result;
  for (const Index member : members) {
    const IndexInBlocks location = locate_in_blocks(blocks, member);
    Index before = 0;
    for (std::size_t block = 0; block < location.block; ++block)
      before += blocks[block].size() * parts_of(blocks[block].shape);
    const Index parts = parts_of(blocks[location.block].shape);
    for (Index part = 0; part < parts; ++part) result.push_back(before + location.local * parts + part);
  }
  return result;
}

/// Number of distinct edges of all cells.
std::size_t count_edges(const Mesh& mesh) {
  std::vector<std::pair<Index, Index>> edges;
  for (const CellBlock& block : mesh.cells) {
    for (const std::vector<int>& node : node_vertices(block.shape, 2)) {
      if (node.size() != 2) continue;
      for (Index cell = 0; cell < block.size(); ++cell) {
        const Index one = block.cell(cell)[node[0]], other = block.cell(cell)[node[1]];
        edges.emplace_back(std::min(one, other), std::max(one, other));
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  return static_cast<std::size_t>(std::unique(edges.begin(), edges.end()) - edges.begin());
}

/// Refuses a refinement long before memory is full.
void require_room(const Mesh& mesh, int times) {
  double cells = 0.0, bytes = 0.0;
  for (const CellBlock& block : mesh.cells) {
    const double parts =
        std::pow(static_cast<double>(parts_of(block.shape)), times) * static_cast<double>(block.size());
    cells += parts;
    bytes += parts *
             static_cast<double>(static_cast<std::size_t>(block.nodes_per_cell) * sizeof(Index) + sizeof(std::int64_t));
  }
  const double there = physical_memory();
  if (cells <= std::numeric_limits<int>::max() && bytes <= there) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("{}: refined {} times, the mesh would have {:.3g} cells, {}: refine it fewer times",
                          mesh.source, times, cells,
                          bytes > there
                              ? fmt::format("whose node numbers alone need {:.3g} GB, while this machine has {:.3g} GB",
                                            1e-9 * bytes, 1e-9 * there)
                              : "more than can be numbered"));
}

Bounds bounds_of(const Mesh& mesh) {
  Index of_faces = 0;
  for (const CellBlock& block : mesh.cells) {
    if (is_tensor(block.shape)) of_faces += block.size() * (dimension(block.shape) == 2 ? 1 : 6);
  }
  const auto faces = static_cast<std::size_t>(of_faces), middles = faces / 6;
  if (mesh.degree == 1) return {count_edges(mesh), faces, middles};
  // Distinct edges of the parts of one cell: 25 for a tetrahedron, 54 for a hexahedron; cells share some of them.
  return {54 * static_cast<std::size_t>(mesh.cell_count()), 36 * faces, 8 * middles};
}

void refine_once(Mesh& mesh) {
  NewNodes nodes(mesh, bounds_of(mesh));
  Cutter cutter(mesh, nodes);
  std::vector<CellBlock> cells, facets;
  for (const CellBlock& block : mesh.cells) cells.push_back(cutter.cut(block));
  for (const CellBlock& block : mesh.facets) facets.push_back(cutter.cut(block));
  for (Group& group : mesh.groups) {
    const bool is_of_cells = group.dimension == mesh.dimension;
    group.members = numbers_of_parts(is_of_cells ? mesh.cells : mesh.facets, group.members);
  }
  mesh.cells = std::move(cells);
  mesh.facets = std::move(facets);
  nodes.add();
}

}  // namespace

void refine(Mesh& mesh, int times) {
  require_room(mesh, times);
  for (int i = 0; i < times; ++i) refine_once(mesh);
}

}  // namespace ricochet
