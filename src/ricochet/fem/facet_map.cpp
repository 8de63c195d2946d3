#include "ricochet/fem/facet_map.hpp"

#include <cmath>
#include <limits>

namespace ricochet {

namespace {

constexpr int most_iterations = 30;
/// Step size in reference coordinates below which Newton's method has converged: it squares the error, so that the
/// error after such a step is below rounding.
constexpr double settled = 1e-9;
/// Step size below which it has converged if two successive steps confirm the quadratic rate.
constexpr double nearly_settled = 1e-7;
/// Distance outside of a facet, in reference coordinates, beyond which points do not belong to it.
constexpr double largest_coordinate = 3.0;

/// Finds the reference coordinates of successive points on a facet projected onto a plane: Newton's method starts from
/// an extrapolation of the last point by its derivative, or else from the centre.
class PointInversion {
 public:
  PointInversion(const PolynomialMap<2>& projection, bool is_segment, const Eigen::Vector2d& centre)
      : projection_(projection), is_segment_(is_segment), centre_(centre) {}

  /// Returns false if there is no such point.
  [[nodiscard]] bool find(const Eigen::Vector2d& target) {
    if (is_solved_ && settle(at_ + solve(target - target_), target)) return true;
    return settle(centre_, target);
  }
  [[nodiscard]] const Eigen::Vector2d& at() const { return at_; }

 private:
  /// Applies the inverse of the derivative to a vector in the plane.
  [[nodiscard]] Eigen::Vector2d solve(const Eigen::Vector2d& apart) const {
    const auto& [along, across] = here_.slopes;
    if (is_segment_) return {apart[0] / along[0], 0.0};
    return Eigen::Vector2d(across[1] * apart[0] - across[0] * apart[1], along[0] * apart[1] - along[1] * apart[0]) /
           (along[0] * across[1] - across[0] * along[1]);
  }

  bool settle(const Eigen::Vector2d& from, const Eigen::Vector2d& target) {
    at_ = from;
    target_ = target;
    is_solved_ = false;
    double last = 0.0;
    for (int k = 0; k < most_iterations && !is_solved_; ++k) {
      here_ = projection_.evaluate(at_.data());
      const Eigen::Vector2d step = solve(here_.at - target);
      at_ -= step;
      if (!(at_.lpNorm<Eigen::Infinity>() <= largest_coordinate)) return false;
      // Steps decrease quadratically, s₂ = c s₁²; the error after the second one is therefore c s₂².
      const double size = step.lpNorm<Eigen::Infinity>();
      is_solved_ = size <= settled || (size <= nearly_settled &&
                                       size * size * size <= std::numeric_limits<double>::epsilon() * last * last);
      last = size;
    }
    return is_solved_;
  }

  const PolynomialMap<2>& projection_;
  bool is_segment_;
  Eigen::Vector2d centre_, at_, target_;
  PolynomialMap<2>::Evaluation here_;
  bool is_solved_ = false;  ///< whether `at_` is the solution for `target_`
};

void tabulate(const PolynomialShape& shape, const Points& local, Matrix& values) {
  values.resize(shape.node_count(), local.cols());
  for (Index q = 0; q < local.cols(); ++q) shape.values(local.col(q).data(), values.col(q).data());
}

/// Ratio of the area of a facet to that of its projection: axes in the columns, the second zero in 2D.
double area_ratio(const PolynomialMap<3>::Evaluation& at, const Eigen::Matrix<double, 3, 2>& axes, bool is_segment) {
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

PolynomialMap<3> FacetMap::geometry(const IndexInBlocks& location) const {
  const PolynomialShape& shape = shapes_[location.block].geometry;
  const Index* const nodes = body_.mesh->facets[location.block].cell(location.local);
  PolynomialMap<3>::NodePositions node_positions = PolynomialMap<3>::NodePositions::Zero();
  for (Index k = 0; k < shape.node_count(); ++k)
    node_positions.col(k).head(body_.mesh->dimension) = body_.mesh->nodes.col(nodes[k]);
  return {shape, node_positions};
}

void FacetMap::positions(Index facet, const Points& local, Points& result) const {
  const PolynomialMap<3> map = geometry(locate_facet(*body_.space, facet));
  const Index d = body_.mesh->dimension;
  result.resize(d, local.cols());
  for (Index q = 0; q < local.cols(); ++q) result.col(q) = map.evaluate(local.col(q).data()).at.head(d);
}

bool FacetMap::invert(Index facet, const Points& axes, const Points& plane, Points& local) const {
  const IndexInBlocks location = locate_facet(*body_.space, facet);
  const CellBlock& block = body_.mesh->facets[location.block];
  const Index* const nodes = block.cell(location.local);
  PolynomialMap<2>::NodePositions node_positions = PolynomialMap<2>::NodePositions::Zero();
  for (Index k = 0; k < block.nodes_per_cell; ++k)
    node_positions.col(k).head(axes.cols()) = axes.transpose() * body_.mesh->nodes.col(nodes[k]);
  const PolynomialMap<2> projection(shapes_[location.block].geometry, node_positions);
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  centre.head(axes.cols()) = reference_centre(block.shape);
  PointInversion finder(projection, axes.cols() == 1, centre);
  local.resize(axes.cols(), plane.cols());
  Eigen::Vector2d target = Eigen::Vector2d::Zero();
  for (Index q = 0; q < plane.cols(); ++q) {
    target.head(axes.cols()) = plane.col(q);
    if (!finder.find(target)) return false;
    local.col(q) = finder.at().head(axes.cols());
  }
  return true;
}

void FacetMap::evaluate(Index facet, const Points& axes, const Vector& weights, FacetPoints& points) const {
  const IndexInBlocks location = locate_facet(*body_.space, facet);
  const Index d = axes.rows(), count = points.local.cols();
  tabulate(shapes_[location.block].displacement, points.local, points.displacement);
  tabulate(shapes_[location.block].hats, points.local, points.hats);
  FacetQuadrature& result = points.quadrature;
  result.facet = facet;
  result.shape = body_.mesh->facets[location.block].shape;
  result.nodes = body_.space->facets[location.block].cell(location.local);
  result.displacement = &points.displacement;
  result.hats = &points.hats;
  result.positions.resize(d, count);
  result.measure.resize(count);
  Eigen::Matrix<double, 3, 2> all_axes = Eigen::Matrix<double, 3, 2>::Zero();
  all_axes.topLeftCorner(d, d - 1) = axes;
  const PolynomialMap<3> map = geometry(location);
  for (Index q = 0; q < count; ++q) {
    const PolynomialMap<3>::Evaluation at = map.evaluate(points.local.col(q).data());
    result.positions.col(q) = at.at.head(d);
    const double ring = is_axisymmetric(body_) ? ring_length(at.at[0]) : 1.0;
    result.measure[q] = weights[q] * area_ratio(at, all_axes, d == 2) * ring;
  }
}

PolynomialMap<3> FacetMap::map_of(Index facet) const { return geometry(locate_facet(*body_.space, facet)); }

double FacetMap::density(const PolynomialMap<3>::Evaluation& at) const {
  const auto& [along, across] = at.slopes;
  const double area = body_.mesh->dimension == 2 ? along.norm() : along.cross(across).norm();
  return is_axisymmetric(body_) ? ring_length(at.at[0]) * area : area;
}

void FacetMap::displacement(Index facet, const Points& local, Matrix& values) const {
  tabulate(shapes_[locate_facet(*body_.space, facet).block].displacement, local, values);
}

void FacetMap::hats(Index facet, const Points& local, Matrix& values) const {
  tabulate(shapes_[locate_facet(*body_.space, facet).block].hats, local, values);
}

}  // namespace ricochet
