#include "ricochet/fem/boundary_ridges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "ricochet/fem/polynomial_shape.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Contribution of one facet to a ridge.
struct RidgeSide {
  std::array<Index, 2> nodes;  ///< ascending
  std::size_t facet;
  bool ascends;  ///< whether the facet's border goes from the first node to the second; in 2D whether it ends here
  Eigen::Vector3d normal, along;
};

class RidgeSides {
 public:
  RidgeSides(const Body& body, std::vector<RidgeSide>& result) : body_(body), result_(result) {
    for (const CellShape shape : cell_shapes()) {
      if (dimension(shape) == body.mesh->dimension - 1)
        shapes_.emplace(shape, PolynomialShape(shape, body.mesh->degree));
    }
  }

  void add(std::size_t number, const CellFacet& facet) {
    const CellBlock& block = body_.space->cells[facet.block];
    const std::vector<int>& corners = outward_facet_vertices(block.shape)[facet.local];
    const PolynomialMap<3> map(shapes_.at(facet_shape(block.shape, facet.local)), positions(facet));
    const std::size_t count = corners.size();
    for (std::size_t k = 0; k < count; ++k) {
      const int first = corners[k], second = count == 2 ? first : corners[(k + 1) % count];
      RidgeSide side;
      const Index* const nodes = block.cell(facet.cell);
      side.nodes = {std::min(nodes[first], nodes[second]), std::max(nodes[first], nodes[second])};
      side.facet = number;
      side.ascends = count == 2 ? k == 1 : nodes[first] < nodes[second];
      const Eigen::Vector2d at = 0.5 * (reference_point(facet, first) + reference_point(facet, second));
      side.normal = normal(facet, map.evaluate(at.data()));
      side.along = Eigen::Vector3d::UnitZ();
      if (count > 2) side.along = (position(facet, second) - position(facet, first)).normalized();
      result_.push_back(side);
    }
  }

 private:
  [[nodiscard]] Eigen::Vector3d position(const CellFacet& facet, int node) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    result.head(body_.mesh->dimension) = body_.mesh->nodes.col(body_.mesh->cells[facet.block].cell(facet.cell)[node]);
    return result;
  }
  [[nodiscard]] PolynomialMap<3>::NodePositions positions(const CellFacet& facet) const {
    const CellShape shape = body_.space->cells[facet.block].shape;
    PolynomialMap<3>::NodePositions result = PolynomialMap<3>::NodePositions::Zero();
    Index k = 0;
    for (const int node : facet_nodes(shape, body_.mesh->degree)[facet.local]) result.col(k++) = position(facet, node);
    return result;
  }
  /// Reference coordinates on the facet of a vertex of its cell.
  [[nodiscard]] Eigen::Vector2d reference_point(const CellFacet& facet, int vertex) const {
    const CellShape shape = body_.space->cells[facet.block].shape;
    const std::vector<int>& nodes = facet_nodes(shape, 1)[facet.local];
    const auto local = int(std::ranges::find(nodes, vertex) - nodes.begin());
    return reference_position(facet_shape(shape, facet.local), {local}).head<2>();
  }
  /// Outward normal, oriented by the order of the facet's corners.
  [[nodiscard]] Eigen::Vector3d normal(const CellFacet& facet, const PolynomialMap<3>::Evaluation& at) const {
    const std::vector<int>& corners = outward_facet_vertices(body_.space->cells[facet.block].shape)[facet.local];
    const Eigen::Vector3d side = position(facet, corners[1]) - position(facet, corners[0]);
    if (corners.size() == 2) {
      const Eigen::Vector3d along = side.dot(at.slopes[0]) > 0.0 ? at.slopes[0] : Eigen::Vector3d(-at.slopes[0]);
      return Eigen::Vector3d(along[1], -along[0], 0.0).normalized();
    }
    const Eigen::Vector3d flat = side.cross(position(facet, corners[2]) - position(facet, corners[0]));
    const Eigen::Vector3d result = at.slopes[0].cross(at.slopes[1]).normalized();
    return result.dot(flat) > 0.0 ? result : Eigen::Vector3d(-result);
  }

  const Body& body_;
  std::vector<RidgeSide>& result_;
  std::map<CellShape, PolynomialShape> shapes_;  ///< of facets
};

}  // namespace

std::vector<Ridge> boundary_ridges(const Body& body, const std::vector<CellFacet>& boundary) {
  std::vector<RidgeSide> sides;
  RidgeSides gather(body, sides);
  for (std::size_t number = 0; number < boundary.size(); ++number) gather.add(number, boundary[number]);
  std::ranges::sort(sides, [](const RidgeSide& a, const RidgeSide& b) {
    return std::tuple(a.nodes, a.facet, a.ascends) < std::tuple(b.nodes, b.facet, b.ascends);
  });
  std::vector<Ridge> ridges;
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].nodes == sides[first].nodes) ++last;
    if (last - first != 2 || sides[first].ascends == sides[first + 1].ascends) continue;
    const RidgeSide& from = sides[sides[first].ascends ? first : first + 1];
    const RidgeSide& to = sides[sides[first].ascends ? first + 1 : first];
    const double angle = std::atan2(from.normal.cross(to.normal).dot(from.along), from.normal.dot(to.normal));
    ridges.push_back({from.nodes, {from.facet, to.facet}, {from.normal, to.normal}, angle, 0.0});
  }
  std::vector<std::vector<std::size_t>> of_facet(boundary.size());
  for (std::size_t k = 0; k < ridges.size(); ++k) {
    for (const std::size_t facet : ridges[k].facets) of_facet[facet].push_back(k);
  }
  for (std::size_t k = 0; k < ridges.size(); ++k) {
    for (const std::size_t facet : ridges[k].facets) {
      for (const std::size_t other : of_facet[facet]) {
        if (other != k) ridges[k].adjacent_angle = std::max(ridges[k].adjacent_angle, std::abs(ridges[other].angle));
      }
    }
  }
  return ridges;
}

bool is_sharp(double angle, double adjacent_angle) {
  constexpr double degree = std::numbers::pi / 180.0, rounding = 1e-9;
  const double size = std::abs(angle) + rounding;
  return size >= 60.0 * degree || (size >= 30.0 * degree && size > 2.0 * adjacent_angle);
}

}  // namespace ricochet
