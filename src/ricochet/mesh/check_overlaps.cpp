#include "ricochet/mesh/check_overlaps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet::gmsh {

namespace {

/// Relative to the full angle: far above the rounding of sums, far below the angle of a cell.
constexpr double tolerance = 1e-6;

/// An edge of a cell by its ends and, for degree 2, its middle.
struct Edge {
  int begin, end, middle;
};

/// Per vertex of a shape, the edges that begin there.
std::vector<std::vector<Edge>> edges_at_vertices(CellShape shape, int degree) {
  std::vector<std::vector<Edge>> result(static_cast<std::size_t>(vertex_count(shape)));
  const auto& nodes = node_vertices(shape, 2);
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    if (nodes[node].size() != 2 || nodes[node][0] == nodes[node][1]) continue;
    int middle = -1;
    if (degree == 2) middle = static_cast<int>(node);
    const int one = nodes[node][0], other = nodes[node][1];
    result[static_cast<std::size_t>(one)].push_back({one, other, middle});
    result[static_cast<std::size_t>(other)].push_back({other, one, middle});
  }
  return result;
}

/// Unit tangent of the edge at its beginning: cells that share the edge share the tangent, and faces of cells are plane
/// to first order there.
Eigen::Vector3d direction(const Mesh& mesh, const Index* cell, const Edge& edge) {
  Eigen::Vector3d tangent = Eigen::Vector3d::Zero();
  for (int k = 0; k < mesh.dimension; ++k) {
    const double begin = mesh.nodes(k, cell[edge.begin]);
    tangent[k] = mesh.nodes(k, cell[edge.end]) - begin;
    if (edge.middle >= 0) tangent[k] = 4.0 * (mesh.nodes(k, cell[edge.middle]) - begin) - tangent[k];
  }
  return tangent / tangent.norm();
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Solid angle between unit vectors (A. van Oosterom, J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125–126).
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return 2.0 * std::atan2(std::abs(a.dot(b.cross(c))), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
}

/// Per node, the sum of the angles of the cells that have it as a vertex.
std::vector<double> sums_of_angles(const Mesh& mesh) {
  std::vector<double> sums(static_cast<std::size_t>(mesh.node_count()), 0.0);
  for (const CellBlock& block : mesh.cells) {
    const auto vertices = edges_at_vertices(block.shape, mesh.degree);
    for (Index k = 0; k < block.size(); ++k) {
      const Index* cell = block.cell(k);
      for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        const std::vector<Edge>& edges = vertices[vertex];
        const Eigen::Vector3d a = direction(mesh, cell, edges[0]), b = direction(mesh, cell, edges[1]);
        sums[static_cast<std::size_t>(cell[vertex])] +=
            mesh.dimension == 2 ? angle(a, b) : solid_angle(a, b, direction(mesh, cell, edges[2]));
      }
    }
  }
  return sums;
}

}  // namespace

void warn_of_overlaps(const Mesh& mesh) {
  const double full_angle = (mesh.dimension == 2 ? 2.0 : 4.0) * std::numbers::pi;
  const std::vector<double> sums = sums_of_angles(mesh);
  std::size_t count = 0, worst = 0;
  for (std::size_t node = 0; node < sums.size(); ++node) {
    if (!(sums[node] > (1.0 + tolerance) * full_angle)) continue;
    ++count;
    if (count == 1 || sums[node] > sums[worst]) worst = node;
  }
  if (count == 0) return;
  const auto position = mesh.nodes.col(static_cast<Index>(worst));
  log::warning(fmt::format(
      "{}: cells overlap: around node {} at ({:.6g}) they fill {:.3g} times the full angle{}; the mass and the "
      "stiffness of the body are counted twice there: remesh the part",
      mesh.source, mesh.node_tags[worst], fmt::join(position.begin(), position.end(), ", "), sums[worst] / full_angle,
      count > 1 ? fmt::format(" ({} affected, too)", counted(count - 1, "other node is", "other nodes are")) : ""));
}

}  // namespace ricochet::gmsh
