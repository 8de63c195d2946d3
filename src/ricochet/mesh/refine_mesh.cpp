#include "ricochet/mesh/refine_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/base/memory.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"
#include "ricochet/mesh/vertex_set_table.hpp"

namespace ricochet {

namespace {

/// New nodes, each created once for all cells that need it.
class NewNodes {
 public:
  explicit NewNodes(Mesh& mesh) : mesh_(mesh) {}

  /// Returns the node at the mean of some vertices of the mesh; if missing, creates it at position().
  template <class Position>
  Index at_mean(const std::vector<Index>& vertices, const Position& position) {
    if (vertices.size() == 1) return vertices.front();
    const auto count = int(vertices.size());
    NodeTable& entry = node_tables_.try_emplace(count, NodeTable{VertexSetTable(count), {}}).first->second;
    const Index found = entry.table.find_or_add(vertices.data());
    if (found >= 0) return entry.nodes[std::size_t(found)];
    positions_.push_back(position());
    entry.nodes.push_back(mesh_.node_count() + Index(positions_.size()) - 1);
    return entry.nodes.back();
  }
  /// Position of a node of the mesh or of a new one.
  [[nodiscard]] Eigen::Vector3d position_of(Index node) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    if (node >= mesh_.node_count()) return positions_[std::size_t(node - mesh_.node_count())];
    result.head(mesh_.dimension) = mesh_.nodes.col(node);
    return result;
  }
  /// Adds the new nodes to the mesh.
  void add() {
    const Index before = mesh_.node_count();
    mesh_.nodes.conservativeResize(Eigen::NoChange, before + Index(positions_.size()));
    for (std::size_t i = 0; i < positions_.size(); ++i)
      mesh_.nodes.col(before + Index(i)) = positions_[i].head(mesh_.dimension);
    mesh_.node_tags.resize(std::size_t(mesh_.nodes.cols()), 0);
  }

 private:
  struct NodeTable {
    VertexSetTable table;
    std::vector<Index> nodes;
  };

  Mesh& mesh_;
  std::map<int, NodeTable> node_tables_;  ///< by the number of vertices: edges, quadrilaterals, hexahedra
  std::vector<Eigen::Vector3d> positions_;
};

/// Cuts the elements of a mesh into parts.
class Cutter {
 public:
  Cutter(const Mesh& mesh, NewNodes& nodes) : mesh_(mesh), nodes_(nodes) {}

  /// Returns the parts of all elements, one block per shape, in the order of the shapes.
  std::vector<CellBlock> cut(const std::vector<CellBlock>& blocks) {
    std::map<CellShape, CellBlock> by_shape;
    for (const CellBlock& block : blocks) {
      shape_ = block.shape;
      for (Index cell = 0; cell < block.size(); ++cell) {
        cell_ = block.cell(cell);
        for (const CellShapeDescription::Child& child : best_subdivision().children) {
          CellBlock& parts = by_shape[child.shape];
          add_nodes(child, parts.nodes);
          parts.tags.push_back(block.tags[std::size_t(cell)]);
        }
      }
    }
    std::vector<CellBlock> result;
    for (auto& [shape, parts] : by_shape)
      result.push_back({shape, node_count(shape, mesh_.degree), std::move(parts.nodes), std::move(parts.tags)});
    return result;
  }

 private:
  /// Chooses the shortest diagonal, of equal ones the first, independently of rounding.
  const CellShapeDescription::Subdivision& best_subdivision() {
    const std::vector<CellShapeDescription::Subdivision>& all = describe(shape_).subdivisions;
    if (all.size() == 1) return all.front();
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const VertexSets& ends = all[i].diagonal;
      const double length = (nodes_.position_of(node_at(ends[0])) - nodes_.position_of(node_at(ends[1]))).norm();
      if (length < least * (1.0 - 1e-12)) {
        least = length;
        best = i;
      }
    }
    return all[best];
  }

  Index node_at(const VertexSet& mean) {
    if (mesh_.degree == 2) return cell_[node_at_mean(shape_, mean)];
    std::vector<Index> vertices;
    for (const int vertex : mean) vertices.push_back(cell_[vertex]);
    return nodes_.at_mean(vertices, [&] {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Index vertex : vertices) sum += nodes_.position_of(vertex);
      return Eigen::Vector3d(sum / double(vertices.size()));
    });
  }

  /// Position of a reference point on the second-order geometry.
  [[nodiscard]] Eigen::Vector3d position_in_cell(const Eigen::Vector3d& at) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    const VertexSets& nodes = node_vertices(shape_, 2);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      result +=
          describe(shape_).lagrange(2, reference_position(shape_, nodes[i]), at).value * nodes_.position_of(cell_[i]);
    return result;
  }

  void add_nodes(const CellShapeDescription::Child& child, std::vector<Index>& result) {
    std::vector<Index> vertices;
    for (const VertexSet& mean : child.vertices) vertices.push_back(node_at(mean));
    for (const VertexSet& local : node_vertices(child.shape, mesh_.degree)) {
      std::vector<Index> of_mesh;
      Eigen::Vector3d at = Eigen::Vector3d::Zero();
      for (const int vertex : local) {
        of_mesh.push_back(vertices[std::size_t(vertex)]);
        at += reference_position(shape_, child.vertices[std::size_t(vertex)]);
      }
      result.push_back(nodes_.at_mean(of_mesh, [&] { return position_in_cell(at / double(local.size())); }));
    }
  }

  const Mesh& mesh_;
  NewNodes& nodes_;
  CellShape shape_ = CellShape::triangle;
  const Index* cell_ = nullptr;
};

const std::vector<CellShapeDescription::Child>& children_of(CellShape shape) {
  return describe(shape).subdivisions.front().children;
}

/// Numbers, through all blocks, of the parts of some elements.
std::vector<Index> numbers_of_parts(const std::vector<CellBlock>& blocks, const std::vector<CellBlock>& parts,
                                    const std::vector<Index>& members) {
  const auto count = [](CellShape parent, CellShape child) {
    const auto has_shape = [child](const CellShapeDescription::Child& each) { return each.shape == child; };
    return Index(std::count_if(children_of(parent).begin(), children_of(parent).end(), has_shape));
  };
  std::vector<Index> result;
  for (const Index member : members) {
    const IndexInBlocks location = locate_in_blocks(blocks, member);
    Index first = 0;  // of the block of parts
    for (const CellBlock& block : parts) {
      const Index here = count(blocks[location.block].shape, block.shape);
      Index before = location.local * here;
      for (std::size_t k = 0; k < location.block; ++k) before += blocks[k].size() * count(blocks[k].shape, block.shape);
      for (Index part = 0; part < here; ++part) result.push_back(first + before + part);
      first += block.size();
    }
  }
  std::ranges::sort(result);
  return result;
}

/// Refuses a refinement long before memory is full.
void require_room(const Mesh& mesh, int times) {
  double cells = 0.0, bytes = 0.0;
  for (const CellBlock& block : mesh.cells) {
    const double parts = std::pow(double(children_of(block.shape).size()), times) * double(block.size());
    cells += parts;
    bytes += parts * double(std::size_t(block.nodes_per_cell) * sizeof(Index) + sizeof(std::int64_t));
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

void refine_once(Mesh& mesh) {
  NewNodes nodes(mesh);
  Cutter cutter(mesh, nodes);
  std::vector<CellBlock> cells = cutter.cut(mesh.cells), facets = cutter.cut(mesh.facets);
  for (Group& group : mesh.groups) {
    const bool is_of_cells = group.dimension == mesh.dimension;
    group.members =
        numbers_of_parts(is_of_cells ? mesh.cells : mesh.facets, is_of_cells ? cells : facets, group.members);
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
