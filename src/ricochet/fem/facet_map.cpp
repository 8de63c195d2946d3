#include "ricochet/fem/facet_map.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace ricochet {

namespace {

constexpr int most_iterations = 30;
/// Of the facet's size: what is left when points are where they should be.
constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
/// Points that are farther outside of a facet than this, in reference coordinates, do not belong to it.
constexpr double far_outside = 3.0;

void tabulate(const PolynomialShape& shape, const Points& local, Matrix& values) {
  values.resize(shape.node_count(), local.cols());
  for (Index q = 0; q < local.cols(); ++q) shape.values(local.col(q).data(), values.col(q).data());
}

}  // namespace

FacetMap::FacetMap(const Body& body) : body_(body) {
  for (const CellBlock& block : body.mesh->facets) {
    shapes_.push_back({PolynomialShape(block.shape, body.mesh->degree),
                       PolynomialShape(block.shape, body.space->degree), PolynomialShape(block.shape, 1)});
  }
}

void FacetMap::map_at(const PlaceInBlocks& place, const double* local, SmallMatrix& jacobian,
                      SpaceVector& position) const {
  const PolynomialShape& shape = shapes_[place.block].geometry;
  const Index* const nodes = body_.mesh->facets[place.block].cell(place.local);
  double values[PolynomialShape::most_nodes], gradients[2 * PolynomialShape::most_nodes];
  shape.gradients(local, values, gradients);
  position.setZero();
  jacobian.setZero();
  for (Index k = 0; k < shape.node_count(); ++k) {
    const auto at = body_.mesh->nodes.col(nodes[k]);
    position += values[k] * at;
    for (Index axis = 0; axis < jacobian.cols(); ++axis)
      jacobian.col(axis) += gradients[axis * shape.node_count() + k] * at;
  }
}

void FacetMap::positions(Index facet, const Points& local, Points& result) const {
  const PlaceInBlocks place = locate_facet(*body_.space, facet);
  const PolynomialShape& shape = shapes_[place.block].geometry;
  const Index* const nodes = body_.mesh->facets[place.block].cell(place.local);
  double values[PolynomialShape::most_nodes];
  result.setZero(body_.mesh->dimension, local.cols());
  for (Index q = 0; q < local.cols(); ++q) {
    shape.values(local.col(q).data(), values);
    for (Index k = 0; k < shape.node_count(); ++k) result.col(q) += values[k] * body_.mesh->nodes.col(nodes[k]);
  }
}

bool FacetMap::invert(Index facet, const Points& axes, const Points& plane, Points& local) const {
  const PlaceInBlocks place = locate_facet(*body_.space, facet);
  const Index d = axes.rows();
  const Vector centre = reference_centre(body_.mesh->facets[place.block].shape);
  local.resize(d - 1, plane.cols());
  SmallMatrix jacobian(d, d - 1), seen(d - 1, d - 1);
  SpaceVector position(d), at(d - 1), residual(d - 1);
  for (Index q = 0; q < plane.cols(); ++q) {
    at = centre;
    bool is_there = false;
    for (int k = 0; k < most_iterations; ++k) {
      map_at(place, at.data(), jacobian, position);
      seen.noalias() = axes.transpose() * jacobian;
      residual.noalias() = axes.transpose() * position;
      residual -= plane.col(q);
      const bool was_there = is_there;
      is_there = is_there || residual.lpNorm<Eigen::Infinity>() <=
                                 rounding * (seen.lpNorm<Eigen::Infinity>() + position.lpNorm<Eigen::Infinity>());
      if (was_there) break;  // one more step has taken what digits there are
      at -= seen.inverse() * residual;
      if (!(at.lpNorm<Eigen::Infinity>() <= far_outside)) return false;
    }
    if (!is_there) return false;
    local.col(q) = at;
  }
  return true;
}

void FacetMap::evaluate(Index facet, const Points& axes, const Vector& weights, FacetPoints& points) const {
  const PlaceInBlocks place = locate_facet(*body_.space, facet);
  const Index d = axes.rows();
  tabulate(shapes_[place.block].displacement, points.local, points.displacement);
  tabulate(shapes_[place.block].hats, points.local, points.hats);
  FacetQuadrature& result = points.quadrature;
  result.facet = facet;
  result.shape = body_.mesh->facets[place.block].shape;
  result.nodes = body_.space->facets[place.block].cell(place.local);
  result.displacement = &points.displacement;
  result.hats = &points.hats;
  result.positions.resize(d, points.local.cols());
  result.measure.resize(points.local.cols());
  SmallMatrix jacobian(d, d - 1);
  SpaceVector position(d);
  for (Index q = 0; q < points.local.cols(); ++q) {
    map_at(place, points.local.col(q).data(), jacobian, position);
    result.positions.col(q) = position;
    const double area = d == 2 ? facet_measure<2>(jacobian) : facet_measure<3>(jacobian);
    result.measure[q] = weights[q] * area / std::abs((axes.transpose() * jacobian).determinant());
  }
}

void FacetMap::displacement(Index facet, const Points& local, Matrix& values) const {
  tabulate(shapes_[locate_facet(*body_.space, facet).block].displacement, local, values);
}

void FacetMap::hats(Index facet, const Points& local, Matrix& values) const {
  tabulate(shapes_[locate_facet(*body_.space, facet).block].hats, local, values);
}

}  // namespace ricochet
