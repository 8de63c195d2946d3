#include "ricochet/fem/facet_area.hpp"

#include <Eigen/Geometry>

#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

namespace {

/// Displacement nodes of a facet in the order of its border, or along a segment.
std::vector<int> border_of(CellShape shape, int degree) {
  const std::vector<int>& corners = describe(shape).file_vertices;  // around the facet
  std::vector<int> result;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    result.push_back(corners[k]);
    const bool is_last = k + 1 == corners.size();
    if (degree == 1 || (is_last && dimension(shape) == 1)) continue;
    result.push_back(node_at_mean(shape, {corners[k], corners[is_last ? 0 : k + 1]}));
  }
  return result;
}

}  // namespace

FacetShape make_facet_shape(CellShape shape, int geometry_degree, int displacement_degree, bool axisymmetric) {
  const QuadratureRule rule =
      quadrature(shape, product_quadrature_degree(shape, geometry_degree, displacement_degree, axisymmetric) + 1);
  FacetShape result{dimension(shape) == 1,
                    dimension(shape) == 2 && is_simplex(shape),
                    PolynomialShape(shape, geometry_degree),
                    PolynomialShape(shape, displacement_degree),
                    rule.points,
                    rule.weights,
                    border_of(shape, displacement_degree),
                    {}};
  const Points& nodes = ReferenceElement::get(shape, displacement_degree).nodes();
  result.border_points.resize(nodes.rows(), Index(result.border.size()));
  for (std::size_t k = 0; k < result.border.size(); ++k)
    result.border_points.col(Index(k)) = nodes.col(result.border[k]);
  return result;
}

FacetArea::FacetArea(const FacetShape& shape, const Places& positions, const Places& motions, bool axisymmetric)
    : shape_(shape),
      axisymmetric_(axisymmetric),
      geometry_(shape.geometry, positions),
      motion_(shape.displacement, motions) {}

double FacetArea::density(const double* point) const {
  const PolynomialMap<3>::Evaluation at = geometry_.evaluate(point), moved = motion_.evaluate(point);
  const Eigen::Vector3d along = at.slopes[0] + moved.slopes[0];
  if (shape_.is_segment) return (axisymmetric_ ? ring_length(at.at[0] + moved.at[0]) : 1.0) * along.norm();
  return along.cross(at.slopes[1] + moved.slopes[1]).norm();
}

double FacetArea::whole() const {
  double sum = 0.0;
  for (Index q = 0; q < shape_.rule_weights.size(); ++q)
    sum += shape_.rule_weights[q] * density(shape_.rule_points.col(q).data());
  return sum;
}

double FacetArea::segment(double from, double to) const {
  double sum = 0.0;
  for (Index q = 0; q < shape_.rule_weights.size(); ++q) {
    const double at = from + (to - from) * shape_.rule_points(0, q);
    sum += shape_.rule_weights[q] * density(&at);
  }
  return sum * (to - from);
}

/// Maps the rule of the square to a triangle (Duffy).
double FacetArea::triangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) const {
  const Eigen::Vector2d first = b - a, second = c - a;
  double sum = 0.0;
  for (Index q = 0; q < shape_.rule_weights.size(); ++q) {
    const double x = shape_.rule_points(0, q), y = shape_.rule_points(1, q);
    const double fold = shape_.is_triangle ? 1.0 : 1.0 - x;
    const Eigen::Vector2d at = a + x * first + fold * y * second;
    sum += shape_.rule_weights[q] * fold * density(at.data());
  }
  return sum * (first[0] * second[1] - first[1] * second[0]);
}

}  // namespace ricochet
