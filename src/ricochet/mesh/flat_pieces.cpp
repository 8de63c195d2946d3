#include "ricochet/mesh/flat_pieces.hpp"

#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

std::vector<FlatPiece> pieces_of_interval(int degree) {
  if (degree == 1) return {{0, 1, -1}};
  return {{0, 2, -1}, {2, 1, -1}};
}

std::vector<FlatPiece> pieces_of_triangle(int degree) {
  if (degree == 1) return {{0, 1, 2}};
  const CellShape shape = CellShape::triangle;
  const int a = node_at_mean(shape, {0, 1}), b = node_at_mean(shape, {1, 2}), c = node_at_mean(shape, {0, 2});
  return {{0, a, c}, {a, 1, b}, {c, b, 2}, {a, b, c}};
}

/// Vertices are numbered lexicographically: around the quadrilateral they are 0, 1, 3, 2.
std::vector<FlatPiece> pieces_of_quadrilateral(int degree) {
  if (degree == 1) return {{0, 1, 3}, {0, 3, 2}};
  const CellShape shape = CellShape::quadrilateral;
  const int lower = node_at_mean(shape, {0, 1}), left = node_at_mean(shape, {0, 2}),
            right = node_at_mean(shape, {1, 3}), upper = node_at_mean(shape, {2, 3}),
            middle = node_at_mean(shape, {0, 1, 2, 3});
  std::vector<FlatPiece> pieces;
  for (const std::array<int, 4>& quarter : {std::array{0, lower, middle, left}, std::array{lower, 1, right, middle},
                                            std::array{middle, right, 3, upper}, std::array{left, middle, upper, 2}}) {
    pieces.push_back({quarter[0], quarter[1], quarter[2]});
    pieces.push_back({quarter[0], quarter[2], quarter[3]});
  }
  return pieces;
}

}  // namespace

const std::vector<FlatPiece>& flat_pieces(CellShape facet, int degree) {
  static const std::array<std::vector<FlatPiece>, 6> table{pieces_of_interval(1),      pieces_of_interval(2),
                                                           pieces_of_triangle(1),      pieces_of_triangle(2),
                                                           pieces_of_quadrilateral(1), pieces_of_quadrilateral(2)};
  const std::size_t shape = facet == CellShape::interval ? 0 : facet == CellShape::triangle ? 2 : 4;
  return table[shape + (degree == 1 ? 0 : 1)];
}

}  // namespace ricochet
