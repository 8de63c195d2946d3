#include "ricochet/fem/mesh_measures.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

Eigen::Vector3d position(const Mesh& mesh, Index node) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  result.head(mesh.dimension) = mesh.nodes.col(node);
  return result;
}

/// Mean of the first `count` nodes, the vertices.
Eigen::Vector3d mean(const Mesh& mesh, const Index* nodes, int count) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < count; ++k) sum += position(mesh, nodes[k]);
  return sum / double(count);
}

/// Size, first moment and ∫n of one cell or facet; the sign of n follows from its numbering.
struct Integral {
  double size = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
};

Eigen::Vector3d normal_of(const Matrix& map) {
  if (map.rows() == 2) return {map(1, 0), -map(0, 0), 0.0};
  return Eigen::Vector3d(map.col(0)).cross(Eigen::Vector3d(map.col(1)));
}

Integral integrate(const Mesh& mesh, const BlockIntegration& rule, const CellBlock& block, Index cell) {
  Integral result;
  const Index* const nodes = block.cell(cell);
  for (Index q = 0; q < rule.rule.weights.size(); ++q) {
    const Matrix& gradients = rule.geometry.gradients[std::size_t(q)];
    Matrix map = Matrix::Zero(mesh.dimension, gradients.cols());
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (Index k = 0; k < gradients.rows(); ++k) {
      map += mesh.nodes.col(nodes[k]) * gradients.row(k);
      at += rule.geometry.values(k, q) * position(mesh, nodes[k]);
    }
    const bool is_cell = map.cols() == map.rows();
    const Eigen::Vector3d normal = is_cell ? Eigen::Vector3d::Zero() : normal_of(map);
    const double weight = rule.rule.weights[q] * rule.ring(mesh.nodes, nodes, q);
    const double size = weight * (is_cell ? std::abs(map.determinant()) : normal.norm());
    result.size += size;
    result.moment += size * at;
    result.normal += weight * normal;
  }
  return result;
}

/// Cells at the vertices of facets.
class CellsOfFacets {
 public:
  explicit CellsOfFacets(const Mesh& mesh) : mesh_(mesh), around_(std::size_t(mesh.node_count())) {
    std::vector<char> is_selected(around_.size(), 0);
    for (const CellBlock& block : mesh.facets) {
      for (const Index node : block.nodes) is_selected[std::size_t(node)] = 1;
    }
    for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
      const CellBlock& block = mesh.cells[b];
      for (Index cell = 0; cell < block.size(); ++cell) {
        for (int v = 0; v < vertex_count(block.shape); ++v) {
          const auto node = std::size_t(block.cell(cell)[v]);
          if (is_selected[node] != 0) around_[node].push_back({b, cell});
        }
      }
    }
  }

  /// Returns the number of cells with this facet, and the centre of the first of them.
  [[nodiscard]] std::pair<int, Eigen::Vector3d> find(const CellBlock& facets, Index facet) const {
    const Index* const nodes = facets.cell(facet);
    std::pair<int, Eigen::Vector3d> result{0, Eigen::Vector3d::Zero()};
    for (const CellIndex& location : around_[std::size_t(nodes[0])]) {
      const CellBlock& block = mesh_.cells[location.block];
      const Index *const first = block.cell(location.cell), *const last = first + vertex_count(block.shape);
      const bool has_all = std::all_of(nodes, nodes + vertex_count(facets.shape),
                                       [&](Index node) { return std::find(first, last, node) != last; });
      if (!has_all) continue;
      if (result.first++ == 0) result.second = mean(mesh_, first, vertex_count(block.shape));
    }
    return result;
  }

 private:
  struct CellIndex {
    std::size_t block;
    Index cell;
  };
  const Mesh& mesh_;
  std::vector<std::vector<CellIndex>> around_;
};

/// Calls visit(block, rule, cell in it) for some cells or facets, numbered through all blocks, ascending.
template <class Visit>
void for_each_member(const Mesh& mesh, const std::vector<CellBlock>& blocks, const std::vector<Index>& members,
                     bool axisymmetric, const Visit& visit) {
  Index first = 0;
  auto member = members.begin();
  for (const CellBlock& block : blocks) {
    const BlockIntegration rule(block.shape, mesh.degree, mesh.degree,
                                product_quadrature_degree(block.shape, mesh.degree, 1, axisymmetric), axisymmetric);
    for (; member != members.end() && *member < first + block.size(); ++member) visit(block, rule, *member - first);
    first += block.size();
  }
}

}  // namespace

MeshMeasure measure_group(const Mesh& mesh, const Group& group, bool axisymmetric) {
  MeshMeasure result;
  const bool are_facets = group.dimension == mesh.dimension - 1;
  if ((!are_facets && group.dimension != mesh.dimension) || group.members.empty()) return result;
  const double infinity = std::numeric_limits<double>::infinity();
  result.lowest.head(mesh.dimension).setConstant(infinity);
  result.highest.head(mesh.dimension).setConstant(-infinity);
  std::optional<CellsOfFacets> cells;
  if (are_facets) cells.emplace(mesh);
  for_each_member(mesh, are_facets ? mesh.facets : mesh.cells, group.members, axisymmetric,
                  [&](const CellBlock& block, const BlockIntegration& rule, Index member) {
                    const Integral own = integrate(mesh, rule, block, member);
                    result.size += own.size;
                    result.centre += own.moment;
                    for (int k = 0; k < block.nodes_per_cell; ++k) {
                      const Eigen::Vector3d at = position(mesh, block.cell(member)[k]);
                      result.lowest = result.lowest.cwiseMin(at);
                      result.highest = result.highest.cwiseMax(at);
                    }
                    if (!are_facets) return;
                    const auto [count, inside] = cells->find(block, member);
                    if (count != 1) {
                      ++result.inside;
                      return;
                    }
                    const Eigen::Vector3d out = mean(mesh, block.cell(member), vertex_count(block.shape)) - inside;
                    result.mean_normal += own.normal.dot(out) < 0.0 ? Eigen::Vector3d(-own.normal) : own.normal;
                  });
  result.centre /= result.size;
  result.mean_normal /= result.size;
  return result;
}

namespace {

/// Size of a straight facet from its vertices. A non-planar quadrilateral is cut along either diagonal; the mean of
/// both does not depend on its first vertex.
double facet_size(const Mesh& mesh, const Index* cell, const std::vector<int>& vertices) {
  const auto at = [&](std::size_t k) { return position(mesh, cell[vertices[k]]); };
  if (vertices.size() == 2) return (at(1) - at(0)).norm();
  const auto half = [&](std::size_t i, std::size_t j, std::size_t k) {
    return 0.5 * (at(j) - at(i)).cross(at(k) - at(i)).norm();
  };
  if (vertices.size() == 3) return half(0, 1, 2);
  return 0.5 * (half(0, 1, 2) + half(3, 1, 2) + half(1, 0, 3) + half(2, 0, 3));
}

/// Computes the heights of cells one by one, with the rules of all blocks set up once.
class CellHeights {
 public:
  explicit CellHeights(const Mesh& mesh) : mesh_(mesh) {
    for (const CellBlock& block : mesh.cells) {
      rules_.emplace_back(block.shape, mesh.degree, mesh.degree,
                          product_quadrature_degree(block.shape, mesh.degree, 1));
    }
  }
  [[nodiscard]] double of(const IndexInBlocks& location) const {
    const CellBlock& block = mesh_.cells[location.block];
    const double size = integrate(mesh_, rules_[location.block], block, location.local).size;
    double height = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f < facet_heights(block.shape).size(); ++f) {
      const double area = facet_size(mesh_, block.cell(location.local), facet_nodes(block.shape, 1)[f]);
      height = std::min(height, facet_heights(block.shape)[f] * size / area);
    }
    return height;
  }

 private:
  const Mesh& mesh_;
  std::vector<BlockIntegration> rules_;
};

}  // namespace

std::vector<double> cell_heights(const Mesh& mesh) {
  const CellHeights height(mesh);
  std::vector<double> heights;
  for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
    for (Index cell = 0; cell < mesh.cells[b].size(); ++cell) heights.push_back(height.of({b, cell}));
  }
  return heights;
}

std::vector<double> cell_heights(const Mesh& mesh, const std::vector<Index>& cells) {
  const CellHeights height(mesh);
  std::vector<double> heights;
  for (const Index cell : cells) heights.push_back(height.of(locate_in_blocks(mesh.cells, cell)));
  return heights;
}

double facet_diameter(const Mesh& mesh, Index facet) {
  const IndexInBlocks location = locate_in_blocks(mesh.facets, facet);
  const CellBlock& block = mesh.facets[location.block];
  const Index* const nodes = block.cell(location.local);
  double largest = 0.0;
  for (int i = 0; i < vertex_count(block.shape); ++i) {
    for (int k = 0; k < i; ++k)
      largest = std::max(largest, (mesh.nodes.col(nodes[i]) - mesh.nodes.col(nodes[k])).norm());
  }
  return largest;
}

}  // namespace ricochet
