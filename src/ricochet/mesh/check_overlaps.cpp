#include "ricochet/mesh/check_overlaps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "ricochet/base/angles.hpp"
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

using Cone = std::vector<Edge>;

/// Per vertex of a shape, the cones between edges that fill it: one with two edges in the plane; in space each has
/// three, of which the first is the same, and the others are those of a facet.
std::vector<std::vector<Cone>> cones_at_vertices(CellShape shape, int degree) {
  std::vector<std::vector<Cone>> result(static_cast<std::size_t>(vertex_count(shape)));
  std::vector<Cone> edges(result.size());
  for (const std::vector<int>& ends : node_vertices(shape, 2)) {
    if (ends.size() != 2) continue;
    const int middle = degree == 2 ? node_at_mean(shape, ends) : -1;
    edges[std::size_t(ends[0])].push_back({ends[0], ends[1], middle});
    edges[std::size_t(ends[1])].push_back({ends[1], ends[0], middle});
  }
  if (dimension(shape) == 2) {
    for (std::size_t vertex = 0; vertex < edges.size(); ++vertex) result[vertex].push_back(edges[vertex]);
    return result;
  }
  for (const std::vector<int>& facet : facet_nodes(shape, 1)) {
    for (const int vertex : facet) {
      const Cone& all = edges[std::size_t(vertex)];
      Cone cone{all.front()};
      std::ranges::copy_if(all, std::back_inserter(cone),
                           [&facet](const Edge& edge) { return std::ranges::find(facet, edge.end) != facet.end(); });
      const bool has_first = cone.size() > 1 && cone[1].end == cone[0].end;
      if (!has_first) result[std::size_t(vertex)].push_back(std::move(cone));
    }
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

/// Solid angle between unit vectors (A. van Oosterom, J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125–126).
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return 2.0 * std::atan2(std::abs(a.dot(b.cross(c))), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
}

/// Per node, the sum of the angles of the cells that have it as a vertex.
std::vector<double> sums_of_angles(const Mesh& mesh) {
  std::vector<double> sums(static_cast<std::size_t>(mesh.node_count()), 0.0);
  for (const CellBlock& block : mesh.cells) {
    const auto cones = cones_at_vertices(block.shape, mesh.degree);
    for (Index k = 0; k < block.size(); ++k) {
      const Index* cell = block.cell(k);
      for (std::size_t vertex = 0; vertex < cones.size(); ++vertex) {
        for (const Cone& cone : cones[vertex]) {
          const Eigen::Vector3d a = direction(mesh, cell, cone[0]), b = direction(mesh, cell, cone[1]);
          sums[std::size_t(cell[vertex])] +=
              mesh.dimension == 2 ? angle_between(a, b) : solid_angle(a, b, direction(mesh, cell, cone[2]));
        }
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
  const auto position = mesh.nodes.col(Index(worst));
  log::warning(fmt::format(
      "{}: cells overlap: around node {} at ({:.6g}) they fill {:.3g} times the full angle{}; the mass and the "
      "stiffness of the body are counted twice there: remesh the part",
      mesh.source, mesh.node_tags[worst], fmt::join(position.begin(), position.end(), ", "), sums[worst] / full_angle,
      count > 1 ? fmt::format(" ({} affected, too)", counted(count - 1, "other node is", "other nodes are")) : ""));
}

}  // namespace ricochet::gmsh
