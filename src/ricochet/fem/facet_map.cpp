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

/// at −= A⁻¹ b with one or two equations.
template <class SmallMatrix>
void take_off_solution(const SmallMatrix& a, const SpaceVector& b, SpaceVector& at) {
  if (b.size() == 1) {
    at[0] -= b[0] / a(0, 0);
    return;
  }
  const double determinant = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
  at[0] -= (a(1, 1) * b[0] - a(0, 1) * b[1]) / determinant;
  at[1] -= (a(0, 0) * b[1] - a(1, 0) * b[0]) / determinant;
}

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
  const Index count = shape.node_count(), d = body_.mesh->dimension, axes = d - 1;
  double values[PolynomialShape::most_nodes], gradients[2 * PolynomialShape::most_nodes];
  shape.gradients(local, values, gradients);
  double sums[3][3] = {};  // x, then its derivatives
  for (Index k = 0; k < count; ++k) {
    const double* const at = body_.mesh->nodes.data() + nodes[k] * d;
    for (Index i = 0; i < d; ++i) {
      sums[0][i] += values[k] * at[i];
      for (Index axis = 0; axis < axes; ++axis) sums[axis + 1][i] += gradients[axis * count + k] * at[i];
    }
  }
  for (Index i = 0; i < d; ++i) {
    position[i] = sums[0][i];
    for (Index axis = 0; axis < axes; ++axis) jacobian(i, axis) = sums[axis + 1][i];
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
      take_off_solution(seen, residual, at);
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
