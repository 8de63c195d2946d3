#include "ricochet/contact/turning_normal.hpp"

#include <cmath>

#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Cosine of the angle between a facet's normal and a direction below which the facet says nothing about it.
constexpr double least_cosine = 0.2;
/// Volume of the unit vectors that N is made of, below which they are taken for dependent.
constexpr double least_independent = 0.05;

}  // namespace

TurningNormal::TurningNormal(const Vector& direction) {
  constant_.head(direction.size()) = direction;
}

TurningNormal::TurningNormal(const DisplacementSpace& space, const std::vector<Index>& facets,
                             const Vector& direction) {
  Three wanted = Three::Zero();
  wanted.head(direction.size()) = direction;
  for (const Index facet : facets) add_facet(space, facet, wanted);
  if (crosses_.empty()) {
    constant_ = wanted;
  } else {
    fit(space, wanted);
  }
}

void TurningNormal::add_facet(const DisplacementSpace& space, Index facet, const Three& direction) {
  const PlaceInBlocks place = locate_facet(space, facet);
  const CellBlock& block = space.facets[place.block];
  const Index* const nodes = block.cell(place.local);
  Cross area;
  if (space.dimension == 2) {
    area = {{nodes[0], nodes[1]}, {}, 1.0};
  } else if (block.shape == CellShape::triangle) {
    area = {{nodes[0], nodes[1]}, {nodes[0], nodes[2]}, 0.5};
  } else {
    // The diagonals; vertices of quadrilaterals are numbered like a table (reference_cell.hpp).
    area = {{nodes[0], nodes[3]}, {nodes[1], nodes[2]}, 0.5};
  }
  const Three value = area.factor * vector(area.one, space.nodes, {}).cross(vector(area.other, space.nodes, {}));
  const double cosine = value.dot(direction) / value.norm();
  if (!(std::abs(cosine) > least_cosine)) return;
  if (cosine < 0.0) area.factor = -area.factor;
  crosses_.push_back(area);
}

/// s and β_k.
void TurningNormal::fit(const DisplacementSpace& space, const Three& direction) {
  Eigen::Matrix3d basis;
  basis.col(0) = at(space.nodes, {});
  const Edge one = crosses_.front().one, other = crosses_.front().other;
  basis.col(1) = vector(one, space.nodes, {});
  basis.col(2) = vector(other, space.nodes, {});
  const Eigen::Vector3d lengths = basis.colwise().norm();
  // Where the sum of area vectors lies in the plane of that facet.
  if (std::abs((basis * lengths.cwiseInverse().asDiagonal()).determinant()) < least_independent) {
    crosses_.clear();
    constant_ = direction;
    return;
  }
  const Three factors =
      (basis * lengths.cwiseInverse().asDiagonal()).partialPivLu().solve(direction).cwiseQuotient(lengths);
  for (Cross& cross : crosses_) cross.factor *= factors[0];
  lines_ = {{one, factors[1]}};
  if (other.from >= 0) lines_.push_back({other, factors[2]});
}

TurningNormal TurningNormal::mean(const TurningNormal& one, const TurningNormal& other) {
  if (!other.turns()) return one;
  if (!one.turns()) return other;
  TurningNormal result = one;
  result.crosses_.insert(result.crosses_.end(), other.crosses_.begin(), other.crosses_.end());
  result.lines_.insert(result.lines_.end(), other.lines_.begin(), other.lines_.end());
  for (Cross& cross : result.crosses_) cross.factor *= 0.5;
  for (Line& line : result.lines_) line.factor *= 0.5;
  return result;
}

std::vector<Index> TurningNormal::nodes() const {
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

TurningNormal::Three TurningNormal::at(const Points& nodes, const Vector& displacement) const {
  Three result = constant_;
  for (const Cross& cross : crosses_) {
    result += cross.factor * vector(cross.one, nodes, displacement).cross(vector(cross.other, nodes, displacement));
  }
  for (const Line& line : lines_) result += line.factor * vector(line.edge, nodes, displacement);
  return result;
}

}  // namespace ricochet
