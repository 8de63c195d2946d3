#include "ricochet/mesh/flat_pieces.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <tuple>

#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

namespace {

using Child = CellShapeDescription::Child;

/// Parts with one piece between each of their vertices: the cell itself for degree 1, its subdivision for degree 2.
/// Parts at its vertices are in the order around it.
std::vector<Child> parts_of_cell(CellShape shape, int degree) {
  const CellShapeDescription& cell = describe(shape);
  if (degree == 1) return {{shape, node_vertices(shape, 1)}};
  std::vector<Child> result = cell.subdivisions.front().children;
  const auto rank = [&](const Child& child) {
    return std::ranges::find_if(cell.file_vertices, [&](int vertex) {
      return std::ranges::find(child.vertices, VertexSet{vertex}) != child.vertices.end();
    });
  };
  std::ranges::stable_sort(result, [&](const Child& a, const Child& b) { return rank(a) < rank(b); });
  return result;
}

/// Orients the corners of a piece of a cell positively. Triangles begin at their lowest corner.
void orient_piece(CellShape shape, VertexSets& corners) {
  const auto at = [&](const VertexSet& corner) { return reference_position(shape, corner); };
  const int d = dimension(shape);
  Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
  for (int k = 0; k < d; ++k) edges.col(k) = at(corners[std::size_t(k) + 1]) - at(corners[0]);
  if (edges.determinant() < 0.0) std::swap(corners[corners.size() - 2], corners.back());
  if (d != 2) return;
  const auto is_lower = [&](const VertexSet& one, const VertexSet& other) {
    const Eigen::Vector3d a = at(one), b = at(other);
    return std::tie(a[1], a[0]) < std::tie(b[1], b[0]);
  };
  std::rotate(corners.begin(), std::ranges::min_element(corners, is_lower), corners.end());
}

std::vector<FlatPiece> make_pieces(CellShape shape, int degree) {
  std::vector<FlatPiece> result;
  for (const Child& part : parts_of_cell(shape, degree)) {
    for (const VertexSet& simplex : describe(part.shape).simplices) {
      VertexSets corners;
      for (const int vertex : simplex) corners.push_back(part.vertices[std::size_t(vertex)]);
      orient_piece(shape, corners);
      FlatPiece& piece = result.emplace_back(FlatPiece{-1, -1, -1, -1});
      for (std::size_t k = 0; k < corners.size(); ++k)
        piece[k] = degree == 1 ? corners[k].front() : node_at_mean(shape, corners[k]);
    }
  }
  return result;
}

}  // namespace

const std::vector<FlatPiece>& flat_pieces(CellShape shape, int degree) {
  static const ShapeTable table(make_pieces);
  return table.at(shape, degree);
}

}  // namespace ricochet
