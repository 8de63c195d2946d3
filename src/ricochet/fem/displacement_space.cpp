#include "ricochet/fem/displacement_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "ricochet/base/node_order.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Copies the first nodes (the vertices) of every cell, renumbered.
std::vector<CellBlock> restrict_to_vertices(const std::vector<CellBlock>& blocks, const std::vector<Index>& number) {
  std::vector<CellBlock> result;
  for (const CellBlock& block : blocks) {
    CellBlock reduced{block.shape, vertex_count(block.shape), {}, block.tags};
    for (Index i = 0; i < block.size(); ++i) {
      for (int v = 0; v < reduced.nodes_per_cell; ++v) {
        reduced.nodes.push_back(number[std::size_t(block.cell(i)[v])]);
      }
    }
    result.push_back(std::move(reduced));
  }
  return result;
}

DisplacementSpace vertices_of(const Mesh& mesh) {
  DisplacementSpace space{mesh.dimension, 1, {}, {}, {}, {}};
  std::vector<Index> vertices;
  std::vector<char> is_vertex(static_cast<std::size_t>(mesh.node_count()), 0);
  for (const CellBlock& block : mesh.cells) {
    for (Index i = 0; i < block.size(); ++i) {
      for (int v = 0; v < vertex_count(block.shape); ++v) is_vertex[std::size_t(block.cell(i)[v])] = 1;
    }
  }
  std::vector<Index> number(is_vertex.size(), -1);
  for (std::size_t node = 0; node < is_vertex.size(); ++node) {
    if (is_vertex[node] == 0) continue;
    number[node] = Index(vertices.size());
    vertices.push_back(Index(node));
  }
  space.nodes.resize(mesh.dimension, Index(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    space.nodes.col(Index(i)) = mesh.nodes.col(vertices[i]);
  }
  space.cells = restrict_to_vertices(mesh.cells, number);
  space.facets = restrict_to_vertices(mesh.facets, number);
  return space;
}

/// Adds the nodes of degree 2 to a straight mesh. A node on an edge, face or cell is identified by the vertices of that
/// entity, and its position is their mean: the (multi)linear map sends the centre of the entity there.
class SecondOrderNodes {
 public:
  explicit SecondOrderNodes(const Mesh& mesh) : mesh_(mesh), count_(mesh.node_count()) {}

  std::vector<CellBlock> refine(const std::vector<CellBlock>& blocks) {
    std::vector<CellBlock> result;
    for (const CellBlock& block : blocks) {
      CellBlock refined{block.shape, node_count(block.shape, 2), {}, block.tags};
      refined.nodes.reserve(std::size_t(block.size() * node_count(block.shape, 2)));
      for (Index i = 0; i < block.size(); ++i) {
        for (const std::vector<int>& support : node_vertices(block.shape, 2)) {
          refined.nodes.push_back(node_on(block.cell(i), support));
        }
      }
      result.push_back(std::move(refined));
    }
    return result;
  }

  [[nodiscard]] Points positions() const {
    Points all(mesh_.dimension, count_);
    all.leftCols(mesh_.node_count()) = mesh_.nodes;
    for (const auto& [vertices, node] : numbers_) {
      Vector mean = Vector::Zero(mesh_.dimension);
      for (const Index vertex : vertices) mean += mesh_.nodes.col(vertex);
      all.col(node) = mean / double(vertices.size());
    }
    return all;
  }

 private:
  Index node_on(const Index* cell, const std::vector<int>& support) {
    if (support.size() == 1) return cell[support.front()];
    std::vector<Index> key;
    key.reserve(support.size());
    for (const int vertex : support) key.push_back(cell[vertex]);
    std::ranges::sort(key);
    const auto [entry, added] = numbers_.try_emplace(std::move(key), count_);
    if (added) ++count_;
    return entry->second;
  }

  const Mesh& mesh_;
  Index count_;
  std::map<std::vector<Index>, Index> numbers_;
};

DisplacementSpace in_order_of_mesh(const Mesh& mesh, int degree) {
  if (degree == 1 && mesh.degree == 2) return vertices_of(mesh);
  DisplacementSpace space{mesh.dimension, degree, mesh.nodes, mesh.cells, mesh.facets, {}};
  if (degree == 2 && mesh.degree == 1) {
    SecondOrderNodes nodes(mesh);
    space.cells = nodes.refine(mesh.cells);
    space.facets = nodes.refine(mesh.facets);
    space.nodes = nodes.positions();
  }
  return space;
}

/// Renumbers the nodes by proximity and stores their previous numbers.
void renumber(DisplacementSpace& space) {
  const std::vector<int> order = order_nodes(space.nodes);
  space.number.assign(order.begin(), order.end());
  std::vector<Index> new_number(order.size());
  const Points nodes = std::move(space.nodes);
  space.nodes.resize(nodes.rows(), nodes.cols());
  for (std::size_t i = 0; i < order.size(); ++i) {
    new_number[std::size_t(order[i])] = Index(i);
    space.nodes.col(Index(i)) = nodes.col(order[i]);
  }
  for (std::vector<CellBlock>* blocks : {&space.cells, &space.facets}) {
    for (CellBlock& block : *blocks) {
      for (Index& node : block.nodes) node = new_number[std::size_t(node)];
    }
  }
}

}  // namespace

DisplacementSpace make_displacement_space(const Mesh& mesh, int degree) {
  DisplacementSpace space = in_order_of_mesh(mesh, degree);
  renumber(space);
  return space;
}

double extent(const Points& nodes) { return (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm(); }

std::vector<Index> facet_nodes(const DisplacementSpace& space, const std::vector<Index>& facets) {
  std::vector<Index> nodes;
  for (const Index facet : facets) {
    const IndexInBlocks location = locate_facet(space, facet);
    const CellBlock& block = space.facets[location.block];
    nodes.insert(nodes.end(), block.cell(location.local), block.cell(location.local) + block.nodes_per_cell);
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

NearestNode nearest_node(const DisplacementSpace& space, const Vector& point) {
  NearestNode nearest;
  double best = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < space.cell_node_count(); ++i) {
    const double distance = (space.nodes.col(i) - point).squaredNorm();
    const auto number = [&](Index node) { return space.number[std::size_t(node)]; };
    if (distance < best || (distance == best && number(i) < number(nearest.node))) {
      best = distance;
      nearest.node = i;
    }
  }
  nearest.distance = std::sqrt(best);
  return nearest;
}

}  // namespace ricochet
