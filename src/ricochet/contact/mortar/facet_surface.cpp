#include "ricochet/contact/mortar/facet_surface.hpp"

#include <algorithm>
#include <utility>

#include "ricochet/fem/exterior_facets.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "ricochet/mesh/flat_pieces.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

using Vector3 = FacetSurface::Vector3;

/// Distance, relative to the facet's size, up to which a node counts as lying at the mean of its vertices.
constexpr double straight = 1e-12;

Vector3 in_space(const Points& positions, Index node) {
  Vector3 result = Vector3::Zero();
  result.head(positions.rows()) = positions.col(node);
  return result;
}

/// Whether the nodes of a second-order facet lie on the straight facet, whose pieces it then has.
bool is_straight(CellShape shape, const std::vector<Vector3>& nodes, double size) {
  const auto& vertices_of = node_vertices(shape, 2);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    Vector3 mean = Vector3::Zero();
    for (const int v : vertices_of[k]) mean += nodes[std::size_t(v)] / double(vertices_of[k].size());
    if ((nodes[k] - mean).norm() > straight * size) return false;
  }
  return true;
}

/// Area vector of a triangle, or length vector of a segment, along the normal on the side from which the nodes are in
/// counter-clockwise order, or to the right of the direction of travel.
Vector3 area_vector(const std::array<Vector3, 3>& corners, bool plane) {
  const Vector3 along = corners[1] - corners[0];
  if (plane) return {along[1], -along[0], 0.0};
  return 0.5 * along.cross(corners[2] - corners[0]);
}

}  // namespace

FacetSurface::FacetSurface(const Body& body, const std::vector<Index>& facets, const Vector& shift)
    : FacetSurface(body, facets, shift, false) {}

FacetSurface FacetSurface::moving(const Body& body, const std::vector<Index>& facets) {
  return {body, facets, {}, true};
}

FacetSurface::FacetSurface(const Body& body, const std::vector<Index>& facets, const Vector& shift, bool moves)
    : shift_(shift.size() > 0 ? shift : Vector::Zero(body.mesh->dimension)),
      plane_(body.mesh->dimension == 2),
      moves_(moves) {
  for (const std::vector<Index>& cells : cells_of_facets(*body.mesh, facets)) cells_.push_back(cells.front());
  const std::vector<double> heights = cell_heights(*body.mesh, cells_);
  for (std::size_t k = 0; k < facets.size(); ++k) {
    add_facet(body, facets[k], cells_[k]);
    const double height = facets_.back().cell_height = facets_.back().body_depth = heights[k];
    const IndexInBlocks location = locate_facet(*body.space, facets[k]);
    const CellBlock& block = body.space->facets[location.block];
    for (int i = 0; i < block.nodes_per_cell; ++i) {
      double& least = node_height_.try_emplace(block.cell(location.local)[i], height).first->second;
      least = std::min(least, height);
    }
  }
  boxes_.resize(pieces_.size());
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    for (const Vector3& corner : pieces_[p].corners) boxes_[p].extend(corner);
  }
  if (!boxes_.empty()) tree_ = BoxTree(boxes_);
}

void FacetSurface::move(const Points& nodes) {
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    Piece& piece = pieces_[p];
    boxes_[p].setEmpty();
    for (std::size_t k = 0; k < 3; ++k) {
      piece.corners[k].head(nodes.rows()) = nodes.col(piece.nodes[k]) + shift_;
      boxes_[p].extend(piece.corners[k]);
    }
  }
  for (Facet& facet : facets_) update_geometry(facet);
  if (!boxes_.empty()) tree_.refit(boxes_);
}

/// Computes the area and its vector, and the normals of the pieces, from their corners.
void FacetSurface::update_geometry(Facet& facet) {
  facet.area = 0.0;
  facet.area_vector.setZero();
  for (int p = facet.first_piece; p < facet.first_piece + facet.piece_count; ++p) {
    Piece& piece = pieces_[std::size_t(p)];
    const Vector3 area = area_vector(piece.corners, plane_);
    facet.area += area.norm();
    facet.area_vector += area;
    piece.normal = area.normalized();
  }
}

void FacetSurface::add_facet(const Body& body, Index number, Index cell) {
  const Mesh& mesh = *body.mesh;
  const IndexInBlocks location = locate_in_blocks(mesh.facets, number), behind = locate_in_blocks(mesh.cells, cell);
  const CellBlock& block = mesh.facets[location.block];
  Vector3 moved = Vector3::Zero(), inside = Vector3::Zero();
  moved.head(mesh.dimension) = shift_;
  const CellBlock& cells = mesh.cells[behind.block];
  for (int v = 0; v < vertex_count(cells.shape); ++v)
    inside += (in_space(mesh.nodes, cells.cell(behind.local)[v]) + moved) / vertex_count(cells.shape);
  std::vector<Vector3> nodes;
  for (int k = 0; k < block.nodes_per_cell; ++k)
    nodes.push_back(in_space(mesh.nodes, block.cell(location.local)[k]) + moved);
  Facet facet{number, int(pieces_.size())};
  facet.size = facet_diameter(mesh, number);
  const bool as_straight = mesh.degree == 1 || (!moves_ && is_straight(block.shape, nodes, facet.size));
  for (const FlatPiece& local : flat_pieces(block.shape, as_straight ? 1 : 2)) {
    Piece piece{int(facets_.size()), {}, {}, Vector3::Zero()};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto node = std::size_t(local[k] >= 0 ? local[k] : local[1]);
      piece.corners[k] = nodes[node];
      piece.nodes[k] = block.cell(location.local)[node];
    }
    if (area_vector(piece.corners, plane_).dot(inside - piece.corners[0]) > 0.0) {
      std::swap(piece.corners[0], piece.corners[1]);
      std::swap(piece.nodes[0], piece.nodes[1]);
      if (plane_) {
        piece.corners[2] = piece.corners[1];
        piece.nodes[2] = piece.nodes[1];
      }
    }
    pieces_.push_back(piece);
  }
  facet.piece_count = int(pieces_.size()) - facet.first_piece;
  update_geometry(facet);
  for (int v = 0; v < vertex_count(block.shape); ++v) facet.centre += nodes[std::size_t(v)] / vertex_count(block.shape);
  facets_.push_back(facet);
}

}  // namespace ricochet
