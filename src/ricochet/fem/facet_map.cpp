#include "ricochet/fem/facet_map.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

constexpr int most_iterations = 30;
/// In reference coordinates: Newton's method squares the error, and what a step of this size leaves is below rounding.
constexpr double settled = 1e-9;
/// Points that are farther outside of a facet than this, in reference coordinates, do not belong to it.
constexpr double far_outside = 3.0;

/// Of a facet that is seen in a plane, which has one axis or two: from `at` to the reference coordinates of a place.
bool find_local(const PolynomialMap& seen, const Eigen::Ref<const Vector>& wanted, Eigen::Vector2d& at) {
  for (int k = 0; k < most_iterations; ++k) {
    const PolynomialMap::Place here = seen.evaluate(at.data());
    const auto& [along, across] = here.slopes;
    Eigen::Vector2d step = Eigen::Vector2d::Zero();
    if (wanted.size() == 1) {
      step[0] = (here.at[0] - wanted[0]) / along[0];
    } else {
      const double a = here.at[0] - wanted[0], b = here.at[1] - wanted[1];
      step = Eigen::Vector2d(across[1] * a - across[0] * b, along[0] * b - along[1] * a) /
             (along[0] * across[1] - across[0] * along[1]);
    }
    at -= step;
    if (!(at.lpNorm<Eigen::Infinity>() <= far_outside)) return false;
    if (step.lpNorm<Eigen::Infinity>() <= settled) return true;
  }
  return false;
}

void tabulate(const PolynomialShape& shape, const Points& local, Matrix& values) {
  values.resize(shape.node_count(), local.cols());
  for (Index q = 0; q < local.cols(); ++q) shape.values(local.col(q).data(), values.col(q).data());
}

/// Of a facet over that of its projection: axes in the columns, the second zero in two dimensions.
double area_ratio(const PolynomialMap::Place& at, const Eigen::Matrix<double, 3, 2>& axes, bool is_segment) {
  const auto& [along, across] = at.slopes;
  if (is_segment) return along.norm() / std::abs(axes.col(0).dot(along));
  const Eigen::Vector2d a = axes.transpose() * along, b = axes.transpose() * across;
  return along.cross(across).norm() / std::abs(a[0] * b[1] - a[1] * b[0]);
}

}  // namespace

FacetMap::FacetMap(const Body& body) : body_(body) {
  for (const CellBlock& block : body.mesh->facets) {
    shapes_.push_back({PolynomialShape(block.shape, body.mesh->degree),
                       PolynomialShape(block.shape, body.space->degree), PolynomialShape(block.shape, 1)});
  }
}

PolynomialMap FacetMap::geometry(const PlaceInBlocks& place) const {
  const PolynomialShape& shape = shapes_[place.block].geometry;
  const Index* const nodes = body_.mesh->facets[place.block].cell(place.local);
  PolynomialMap::NodePlaces places = PolynomialMap::NodePlaces::Zero();
  for (Index k = 0; k < shape.node_count(); ++k)
    places.col(k).head(body_.mesh->dimension) = body_.mesh->nodes.col(nodes[k]);
  return {shape, places};
}

void FacetMap::positions(Index facet, const Points& local, Points& result) const {
  const PolynomialMap map = geometry(locate_facet(*body_.space, facet));
  const Index d = body_.mesh->dimension;
  result.resize(d, local.cols());
  for (Index q = 0; q < local.cols(); ++q) result.col(q) = map.evaluate(local.col(q).data()).at.head(d);
}

bool FacetMap::invert(Index facet, const Points& axes, const Points& plane, Points& local) const {
  const PlaceInBlocks place = locate_facet(*body_.space, facet);
  const CellBlock& block = body_.mesh->facets[place.block];
  const Index* const nodes = block.cell(place.local);
  PolynomialMap::NodePlaces places = PolynomialMap::NodePlaces::Zero();
  for (Index k = 0; k < block.nodes_per_cell; ++k)
    places.col(k).head(axes.cols()) = axes.transpose() * body_.mesh->nodes.col(nodes[k]);
  const PolynomialMap seen(shapes_[place.block].geometry, places);
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  centre.head(axes.cols()) = reference_centre(block.shape);
  Eigen::Vector2d at = centre;
  local.resize(axes.cols(), plane.cols());
  for (Index q = 0; q < plane.cols(); ++q) {
    if (!find_local(seen, plane.col(q), at)) {
      at = centre;
      if (!find_local(seen, plane.col(q), at)) return false;
    }
    local.col(q) = at.head(axes.cols());
  }
  return true;
}

void FacetMap::evaluate(Index facet, const Points& axes, const Vector& weights, FacetPoints& points) const {
  const PlaceInBlocks place = locate_facet(*body_.space, facet);
  const Index d = axes.rows(), count = points.local.cols();
  tabulate(shapes_[place.block].displacement, points.local, points.displacement);
  tabulate(shapes_[place.block].hats, points.local, points.hats);
  FacetQuadrature& result = points.quadrature;
  result.facet = facet;
  result.shape = body_.mesh->facets[place.block].shape;
  result.nodes = body_.space->facets[place.block].cell(place.local);
  result.displacement = &points.displacement;
  result.hats = &points.hats;
  result.positions.resize(d, count);
  result.measure.resize(count);
  Eigen::Matrix<double, 3, 2> all_axes = Eigen::Matrix<double, 3, 2>::Zero();
  all_axes.topLeftCorner(d, d - 1) = axes;
  const PolynomialMap map = geometry(place);
  for (Index q = 0; q < count; ++q) {
    const PolynomialMap::Place at = map.evaluate(points.local.col(q).data());
    result.positions.col(q) = at.at.head(d);
    result.measure[q] = weights[q] * area_ratio(at, all_axes, d == 2);
  }
}

void FacetMap::displacement(Index facet, const Points& local, Matrix& values) const {
  tabulate(shapes_[locate_facet(*body_.space, facet).block].displacement, local, values);
}

void FacetMap::hats(Index facet, const Points& local, Matrix& values) const {
  tabulate(shapes_[locate_facet(*body_.space, facet).block].hats, local, values);
}

}  // namespace ricochet
