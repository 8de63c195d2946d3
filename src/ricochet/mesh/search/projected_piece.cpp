#include "ricochet/mesh/search/projected_piece.hpp"

#include <algorithm>

namespace ricochet {

namespace {

/// Clips a polygon to the left of a line (I. E. Sutherland, G. W. Hodgman, Commun. ACM 17, 1974, 32–42).
ProjectedPolygon left_of(const ProjectedPolygon& polygon, const PlanePoint& from, const PlanePoint& to) {
  ProjectedPolygon result;
  const auto side = [&](const PlanePoint& point) { return plane_cross(to - from, point - from); };
  for (int k = 0; k < polygon.count; ++k) {
    const PlanePoint &here = polygon.at(k), &next = polygon.at(k + 1);
    const double s = side(here), t = side(next);
    if (s >= 0.0) result.add(here);
    if ((s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0)) result.add(here + s / (s - t) * (next - here));
  }
  return result;
}

}  // namespace

bool ProjectedPiece::covers(const PlanePoint& at, bool is_segment, double outside) const {
  if (is_segment) {
    const double rim = outside * area;
    return at[0] >= corners[0][0] - rim && at[0] <= corners[1][0] + rim;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const PlanePoint side = corners[(k + 1) % 3] - corners[k];
    if (plane_cross(side, at - corners[k]) < -outside * side.squaredNorm()) return false;
  }
  return true;
}

double ProjectedPolygon::area() const {
  if (count == 2) return corners[1][0] - corners[0][0];
  double twice = 0.0;
  for (int k = 1; k + 1 < count; ++k) twice += plane_cross(at(k) - at(0), at(k + 1) - at(0));
  return 0.5 * twice;
}

ProjectedPolygon intersect(const ProjectedPiece& one, const ProjectedPiece& other, bool are_segments) {
  ProjectedPolygon common;
  if (are_segments) {
    const double from = std::max(one.corners[0][0], other.corners[0][0]);
    const double to = std::min(one.corners[1][0], other.corners[1][0]);
    if (!(from < to)) return common;
    common.add({from, 0.0});
    common.add({to, 0.0});
    return common;
  }
  for (const PlanePoint& corner : one.corners) common.add(corner);
  for (std::size_t k = 0; k < 3 && common.count > 2; ++k)
    common = left_of(common, other.corners[k], other.corners[(k + 1) % 3]);
  if (common.count < 3) common.count = 0;
  return common;
}

}  // namespace ricochet
