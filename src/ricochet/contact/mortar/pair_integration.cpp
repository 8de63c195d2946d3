#include "ricochet/contact/mortar/pair_integration.hpp"

namespace ricochet {

void gather_points(const FacetMap& map, Index facet, const FacetSegments& segments, FacetPoints& points) {
  Index count = 0;
  for (const SurfaceSegment& segment : segments.segments) count += segment.weights.size();
  points.local.resize(segments.axes.cols(), count);
  Vector weights(count);
  Index begin = 0;
  for (const SurfaceSegment& segment : segments.segments) {
    const Index own = segment.weights.size();
    points.local.middleCols(begin, own) = segment.own_local;
    weights.segment(begin, own) = segment.weights;
    begin += own;
  }
  map.evaluate(facet, segments.axes, weights, points);
  points.quadrature.whole = segments.is_whole();
}

/// Integrates once for each distinct direction among the multipliers of the facet.
void PairIntegration::add_facet(int facet, const Eigen::Vector3d& normal, const FacetSegments& direct) {
  const Index number = own_.facets()[std::size_t(facet)].number;
  whole_.evaluate(number, quadrature_);
  space_.evaluate(quadrature_, functions_);
  const std::vector<Index> anchors = functions_.anchors;
  for (std::size_t k = 0; k < anchors.size(); ++k)
    sums_[anchors[k]].whole += functions_.values.row(Index(k)).dot(quadrature_.measure);
  std::vector<char> done(anchors.size(), 0), included(anchors.size(), 0);
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    if (done[k] != 0) continue;
    const Eigen::Vector3d& direction = directions_.at(anchors[k]);
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      included[i] = directions_.at(anchors[i]) == direction ? 1 : 0;
      done[i] = char(done[i] | included[i]);
    }
    if (direction == -normal) {
      add_segments(facet, direct, included);
    } else {
      add_segments(facet, finder_.find(facet, direction), included);
    }
  }
}

void PairIntegration::add_segments(int facet, const FacetSegments& segments, const std::vector<char>& included) {
  lost_ += segments.lost;
  if (segments.segments.empty()) return;
  const Index number = own_.facets()[std::size_t(facet)].number;
  gather_points(map_, number, segments, points_);
  const FacetQuadrature& at = points_.quadrature;
  space_.evaluate(at, functions_);
  const Matrix weighted = functions_.values * at.measure.asDiagonal();
  const Matrix own = weighted * points_.displacement.transpose();
  for (std::size_t k = 0; k < included.size(); ++k) {
    if (included[k] == 0) continue;
    MultiplierSums& sums = sums_[functions_.anchors[k]];
    const auto row = Index(k);
    sums.weight += weighted.row(row).sum();
    for (Index j = 0; j < own.cols(); ++j) sums.own[at.nodes[j]] += own(row, j);
  }
  Index begin = 0;
  Matrix values;
  Points positions;
  for (const SurfaceSegment& segment : segments.segments) {
    const Index count = segment.weights.size();
    map_.displacement(segment.opposite, segment.opposite_local, values);
    map_.positions(segment.opposite, segment.opposite_local, positions);
    const IndexInBlocks location = locate_facet(*body_.space, segment.opposite);
    const Index* const nodes = body_.space->facets[location.block].cell(location.local);
    const Matrix opposite = weighted.middleCols(begin, count) * values.transpose();
    const Points apart = at.positions.middleCols(begin, count) - positions;
    for (std::size_t k = 0; k < included.size(); ++k) {
      if (included[k] == 0) continue;
      MultiplierSums& sums = sums_[functions_.anchors[k]];
      const auto row = Index(k);
      for (Index j = 0; j < opposite.cols(); ++j) sums.opposite[nodes[j]] += opposite(row, j);
      const Eigen::Vector3d& direction = directions_.at(functions_.anchors[k]);
      const Vector gaps = apart.transpose() * direction.head(apart.rows());
      sums.gap += weighted.row(row).segment(begin, count).dot(gaps);
    }
    begin += count;
  }
}

void PressureTransfer::add_facet(Index facet, const FacetSegments& direct) {
  if (direct.segments.empty()) return;
  gather_points(map_, facet, direct, points_);
  Index begin = 0;
  for (const SurfaceSegment& segment : direct.segments) {
    const Index count = segment.weights.size();
    map_.hats(segment.opposite, segment.opposite_local, hats_);
    const IndexInBlocks location = locate_facet(*body_.space, segment.opposite);
    const Index* const nodes = body_.space->facets[location.block].cell(location.local);
    const Matrix weighted = hats_ * points_.quadrature.measure.segment(begin, count).asDiagonal();
    const Matrix products = weighted * points_.hats.middleCols(begin, count).transpose();
    for (Index a = 0; a < products.rows(); ++a) {
      areas_[nodes[a]] += weighted.row(a).sum();
      for (Index v = 0; v < products.cols(); ++v) products_[{nodes[a], points_.quadrature.nodes[v]}] += products(a, v);
    }
    begin += count;
  }
}

std::map<Index, std::vector<std::pair<Index, double>>> PressureTransfer::weights() const {
  std::map<Index, std::vector<std::pair<Index, double>>> result;
  for (const auto& [nodes, product] : products_) {
    const double area = areas_.at(nodes.first);
    if (area > 0.0) result[nodes.first].emplace_back(nodes.second, product / area);
  }
  return result;
}

}  // namespace ricochet
