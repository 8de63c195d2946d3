#include "ricochet/simulation/monitor/surface_pieces.hpp"

#include <utility>

#include "ricochet/mesh/flat_pieces.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

void add_pieces(const Points& positions, const std::vector<CellBlock>& cells, const CellFacet& facet,
                std::vector<BodySurface::Piece>& pieces) {
  const CellBlock& block = cells[facet.block];
  const CellShape shape = facet_shape(block.shape, facet.local);
  const std::vector<Index> nodes = nodes_of_facet(cells, facet);
  const auto at = [&](Index node) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    position.head(positions.rows()) = positions.col(node);
    return position;
  };
  const Eigen::Vector3d origin = at(nodes[0]), along = at(nodes[1]) - origin;
  const Eigen::Vector3d normal = positions.rows() == 2 ? Eigen::Vector3d(along[1], -along[0], 0.0)
                                                       : Eigen::Vector3d(along.cross(at(nodes[2]) - origin));
  double side = 0.0;  // positive if the cell is on the side of the normal
  for (int v = 0; v < vertex_count(block.shape); ++v) side += normal.dot(at(block.cell(facet.cell)[v]) - origin);
  const int degree = degree_of(shape, int(nodes.size()));
  for (const FlatPiece& local : flat_pieces(shape, degree)) {
    BodySurface::Piece piece{-1, -1, -1};
    for (std::size_t k = 0; k < 3; ++k) {
      if (local[k] >= 0) piece[k] = nodes[std::size_t(local[k])];
    }
    if (side > 0.0) std::swap(piece[0], piece[1]);
    pieces.push_back(piece);
  }
}

}  // namespace

std::vector<BodySurface::Piece> surface_pieces(const Points& positions, const std::vector<CellBlock>& cells,
                                               const std::vector<CellFacet>& facets) {
  std::vector<BodySurface::Piece> pieces;
  for (const CellFacet& facet : facets) add_pieces(positions, cells, facet, pieces);
  return pieces;
}

}  // namespace ricochet
