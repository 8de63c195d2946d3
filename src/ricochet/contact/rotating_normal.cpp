#include "ricochet/contact/rotating_normal.hpp"

#include <cmath>
#include <utility>

#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Cosine of the angle between a facet's normal and a direction below which the facet is excluded.
constexpr double least_cosine = 0.2;
/// Volume of the unit vectors that span N below which they count as linearly dependent.
constexpr double least_independent = 0.05;

/// Returns the eigenvectors, perpendicular to `normal`, of a symmetric matrix.
std::pair<RotatingNormal::Vector3, RotatingNormal::Vector3> axes_across(const RotatingNormal::Vector3& normal,
                                                                        const Eigen::Matrix3d& metric) {
  const RotatingNormal::Vector3 one = normal.unitOrthogonal(), other = normal.cross(one);
  const double angle =
      0.5 * std::atan2(2.0 * one.dot(metric * other), one.dot(metric * one) - other.dot(metric * other));
  return {std::cos(angle) * one + std::sin(angle) * other, std::cos(angle) * other - std::sin(angle) * one};
}

}  // namespace

RotatingNormal::RotatingNormal(const Vector& direction) { constant_.head(direction.size()) = direction; }

RotatingNormal::RotatingNormal(const DisplacementSpace& space, const std::vector<Index>& facets,
                               const Vector& direction) {
  Vector3 reference = Vector3::Zero();
  reference.head(direction.size()) = direction;
  for (const Index facet : facets) add_facet(space, facet, reference);
  if (crosses_.empty()) {
    constant_ = reference;
  } else {
    fit(space, reference);
  }
}

void RotatingNormal::add_facet(const DisplacementSpace& space, Index facet, const Vector3& direction) {
  const IndexInBlocks location = locate_facet(space, facet);
  const CellBlock& block = space.facets[location.block];
  const Index* const nodes = block.cell(location.local);
  Cross area;
  if (space.dimension == 2) {
    area = {{nodes[0], nodes[1]}, {}, 1.0};
  } else if (is_simplex(block.shape)) {
    area = {{nodes[0], nodes[1]}, {nodes[0], nodes[2]}, 0.5};
  } else {
    // The diagonals; vertices of quadrilaterals are numbered row by row (reference_cell.hpp).
    area = {{nodes[0], nodes[3]}, {nodes[1], nodes[2]}, 0.5};
  }
  const Vector3 value = area.factor * vector(area.one, space.nodes, {}).cross(vector(area.other, space.nodes, {}));
  const double cosine = value.dot(direction) / value.norm();
  if (!(std::abs(cosine) > least_cosine)) return;
  if (cosine < 0.0) area.factor = -area.factor;
  crosses_.push_back(area);
}

/// Computes s and c from sums over all facets and all their edges, so that the order of facets and
/// of their nodes does not matter.
void RotatingNormal::fit(const DisplacementSpace& space, const Vector3& direction) {
  std::vector<Vector3> weights;  // whose products with c are the factors of the lines
  Eigen::Matrix3d metric = Eigen::Matrix3d::Zero();
  const auto add = [&](const Edge& edge, const Vector3& value, const Vector3& weight) {
    lines_.push_back({edge, 0.0});
    weights.push_back(weight);
    metric += weight * value.transpose();
  };
  for (const Cross& cross : crosses_) {
    const Vector3 one = vector(cross.one, space.nodes, {}), other = vector(cross.other, space.nodes, {});
    const bool is_triangle = cross.one.from == cross.other.from;  // its third edge is the difference
    add(cross.one, one, is_triangle ? Vector3(2.0 * one - other) : one);
    if (cross.other.from >= 0) add(cross.other, other, is_triangle ? Vector3(2.0 * other - one) : other);
  }
  const Vector3 sum = at(space.nodes, {}), normal = sum.normalized();
  // In 2D one of the axes is normal to the plane; no component along it is required.
  if (space.dimension == 2) metric(2, 2) = metric.trace();
  const auto [one, other] = axes_across(normal, metric);
  Eigen::Matrix3d basis;
  basis << sum, metric * one, metric * other;
  const Eigen::Vector3d lengths = basis.colwise().norm();
  const Eigen::Matrix3d units = basis * lengths.cwiseInverse().asDiagonal();
  // The facets around the point fold so that edges are parallel to the sum of area vectors.
  if (!(std::abs(units.determinant()) > least_independent)) {
    crosses_.clear();
    lines_.clear();
    constant_ = direction;
    return;
  }
  const Vector3 factors = units.partialPivLu().solve(direction).cwiseQuotient(lengths);
  const Vector3 along = factors[1] * one + factors[2] * other;
  for (std::size_t k = 0; k < lines_.size(); ++k) lines_[k].factor = weights[k].dot(along);
  for (Cross& cross : crosses_) cross.factor *= factors[0];
}

RotatingNormal RotatingNormal::mean(const RotatingNormal& one, const RotatingNormal& other) {
  if (!other.rotates()) return one;
  if (!one.rotates()) return other;
  RotatingNormal result = one;
  result.crosses_.insert(result.crosses_.end(), other.crosses_.begin(), other.crosses_.end());
  result.lines_.insert(result.lines_.end(), other.lines_.begin(), other.lines_.end());
  for (Cross& cross : result.crosses_) cross.factor *= 0.5;
  for (Line& line : result.lines_) line.factor *= 0.5;
  return result;
}

std::vector<Index> RotatingNormal::nodes() const {
  std::vector<Index> result;
  const auto add = [&result](const Edge& edge) {
    if (edge.from < 0) return;
    result.push_back(edge.from);
    result.push_back(edge.to);
  };
  for (const Cross& cross : crosses_) {
    add(cross.one);
    add(cross.other);
  }
  return result;
}

RotatingNormal::Vector3 RotatingNormal::at(const Points& nodes, const Vector& displacement) const {
  Vector3 result = constant_;
  for (const Cross& cross : crosses_) {
    result += cross.factor * vector(cross.one, nodes, displacement).cross(vector(cross.other, nodes, displacement));
  }
  for (const Line& line : lines_) result += line.factor * vector(line.edge, nodes, displacement);
  return result;
}

}  // namespace ricochet
