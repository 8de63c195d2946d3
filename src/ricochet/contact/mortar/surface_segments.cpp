#include "ricochet/contact/mortar/surface_segments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/mesh/search/projected_piece.hpp"

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;

/// Cosine of the angle to the direction below which a piece is seen edge-on.
constexpr double edge_on = 0.1;
/// Fraction of a piece's area below which an intersection is rounding error.
constexpr double sliver = 1e-13;
/// Excess, relative to a piece's area, above which intersections overlap each other.
constexpr double doubly = 1e-9;

}  // namespace

/// Plane onto which surfaces are projected along a direction.
struct SegmentFinder::View {
  bool plane;  ///< whether the problem is 2D
  Vector3 direction;
  Vector3 first, second;  ///< axes; the second is 0 in 2D

  View(int dimension, const Vector3& along) : plane(dimension == 2), direction(along), second(Vector3::Zero()) {
    if (plane) {
      first = {along[1], -along[0], 0.0};
      return;
    }
    Index axis = 0;
    along.cwiseAbs().minCoeff(&axis);
    first = Vector3::Unit(axis).cross(along).normalized();
    second = along.cross(first);
  }
  [[nodiscard]] Points axes() const {
    const Index d = plane ? 2 : 3;
    Points result(d, d - 1);
    result.col(0) = first.head(d);
    if (!plane) result.col(1) = second;
    return result;
  }
  [[nodiscard]] PlanePoint project(const Vector3& point) const { return {first.dot(point), second.dot(point)}; }

  [[nodiscard]] ProjectedPiece flatten(const FacetSurface::Piece& piece) const {
    ProjectedPiece flat;
    std::array<double, 3> heights{};
    for (std::size_t k = 0; k < 3; ++k) {
      flat.corners[k] = project(piece.corners[k]);
      heights[k] = direction.dot(piece.corners[k]);
    }
    const PlanePoint a = flat.corners[1] - flat.corners[0], b = flat.corners[2] - flat.corners[0];
    if (plane) {
      flat.area = a[0];
      flat.slope = {(heights[1] - heights[0]) / a[0], 0.0};
    } else {
      const double twice = plane_cross(a, b);
      const double da = heights[1] - heights[0], db = heights[2] - heights[0];
      flat.area = 0.5 * twice;
      flat.slope = {(da * b[1] - db * a[1]) / twice, (a[0] * db - b[0] * da) / twice};
    }
    flat.height = heights[0] - flat.slope.dot(flat.corners[0]);
    if (flat.area < 0.0) {
      flat.area = -flat.area;
      std::swap(flat.corners[0], flat.corners[1]);
    }
    return flat;
  }
};

/// Intersection of the projections of an own and an opposite piece.
struct SegmentFinder::Cut {
  int own_piece, opposite_piece;
  ProjectedPiece own, opposite;
  ProjectedPolygon common;  ///< in 2D from corner 0 to corner 1
  double area = 0.0;
  [[nodiscard]] double gap_at(const PlanePoint& at) const { return own.height_at(at) - opposite.height_at(at); }
};

namespace {

bool is_among(const std::vector<int>& facets, int facet) { return std::ranges::binary_search(facets, facet); }

/// Whether the extent of a box along a unit vector overlaps the interval.
bool overlaps(const BoxTree::Box& box, const Vector3& along, double from, double to) {
  const double centre = along.dot(box.center()), half = along.cwiseAbs().dot(0.5 * box.sizes());
  return centre - half <= to && centre + half >= from;
}

}  // namespace

SegmentFinder::SegmentFinder(const FacetMap& map, const FacetSurface& own, const FacetSurface& opposite, int degree)
    : map_(map),
      own_(own),
      opposite_(opposite),
      interval_(quadrature(CellShape::interval, degree)),
      triangle_(quadrature(CellShape::triangle, degree)) {}

/// Finds the opposite pieces that an own piece faces.
void SegmentFinder::cut_piece(const View& view, int number, bool any_depth, std::vector<Cut>& cuts) const {
  const FacetSurface::Piece& piece = own_.pieces()[std::size_t(number)];
  if (-view.direction.dot(piece.normal) < edge_on) return;
  const ProjectedPiece own = view.flatten(piece);
  BoxTree::Box view_box;  // plane coordinates and height
  for (const Vector3& corner : piece.corners) {
    const PlanePoint at = view.project(corner);
    view_box.extend(Vector3(at[0], at[1], view.direction.dot(corner)));
  }
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const double own_depth = any_depth ? infinite : own_.facets()[std::size_t(piece.facet)].body_depth;
  const auto may_face = [&](const BoxTree::Box& box) {
    return overlaps(box, view.first, view_box.min()[0], view_box.max()[0]) &&
           (view.plane || overlaps(box, view.second, view_box.min()[1], view_box.max()[1])) &&
           overlaps(box, view.direction, -infinite, view_box.max()[2] + own_depth);
  };
  opposite_.tree().visit(may_face, [&](int other) {
    const FacetSurface::Piece& candidate = opposite_.pieces()[std::size_t(other)];
    if (view.direction.dot(candidate.normal) < edge_on || piece.normal.dot(candidate.normal) >= 0.0) return;
    if (!ignored_facets_.empty() && is_among(ignored_facets_[std::size_t(piece.facet)], candidate.facet)) return;
    Cut cut{number, other, own, view.flatten(candidate), {}, 0.0};
    cut.common = intersect(own, cut.opposite, view.plane);
    if (cut.common.count == 0) return;
    cut.area = cut.common.area();
    if (!(cut.area > sliver * std::min(own.area, cut.opposite.area))) return;
    PlanePoint centre = PlanePoint::Zero();
    for (int k = 0; k < cut.common.count; ++k) centre += cut.common.at(k) / cut.common.count;
    const double other_depth = opposite_.facets()[std::size_t(candidate.facet)].body_depth;
    if (!any_depth && cut.gap_at(centre) < -deepest_overlap * std::min(own_depth, other_depth)) return;
    cuts.push_back(std::move(cut));
  });
}

/// Adds quadrature points on the intersections, gathered by opposite facet.
void SegmentFinder::add_points(const View& view, const std::vector<Cut>& cuts,
                               std::vector<SurfaceSegment>& segments) const {
  double all = 0.0;
  for (const Cut& cut : cuts) all += cut.area;
  const bool several = !cuts.empty() && all > (1.0 + doubly) * cuts.front().own.area;
  // Whether a nearer piece hides the point.
  const auto is_hidden = [&](const Cut& cut, const PlanePoint& at) {
    const double own = std::abs(cut.gap_at(at));
    return std::ranges::any_of(cuts, [&](const Cut& other) {
      if (&other == &cut || !other.opposite.covers(at, view.plane)) return false;
      const double gap = std::abs(other.gap_at(at));
      return gap < own || (gap == own && other.opposite_piece < cut.opposite_piece);
    });
  };
  for (const Cut& cut : cuts) {
    const Index facet =
        opposite_.facets()[std::size_t(opposite_.pieces()[std::size_t(cut.opposite_piece)].facet)].number;
    auto segment = std::ranges::find_if(segments, [facet](const SurfaceSegment& one) { return one.opposite == facet; });
    if (segment == segments.end()) segment = segments.insert(segments.end(), {facet, {}, {}, {}});
    const QuadratureRule& rule = view.plane ? interval_ : triangle_;
    const int parts = view.plane ? 1 : cut.common.count - 2;
    std::vector<PlanePoint> at;
    std::vector<double> weights;
    for (int part = 0; part < parts; ++part) {
      const PlanePoint origin = cut.common.at(0), a = cut.common.at(part + 1) - origin;
      const PlanePoint b = view.plane ? PlanePoint::Zero() : PlanePoint(cut.common.at(part + 2) - origin);
      const double density = view.plane ? a[0] : plane_cross(a, b);
      for (Index q = 0; q < rule.weights.size(); ++q) {
        const PlanePoint point = origin + rule.points(0, q) * a + (view.plane ? 0.0 : rule.points(1, q)) * b;
        if (several && is_hidden(cut, point)) continue;
        at.push_back(point);
        weights.push_back(density * rule.weights[q]);
      }
    }
    const Index rows = view.plane ? 1 : 2, before = segment->weights.size(), more = Index(at.size());
    segment->own_local.conservativeResize(rows, before + more);  // coordinates in the plane, until they are inverted
    segment->weights.conservativeResize(before + more);
    for (Index q = 0; q < more; ++q) {
      segment->own_local.col(before + q) = at[std::size_t(q)].head(rows);
      segment->weights[before + q] = weights[std::size_t(q)];
    }
  }
}

/// Converts coordinates in the plane, in own_local, to reference coordinates on both facets. Returns false if a facet
/// is so curved that it is seen edge-on.
bool SegmentFinder::find_coordinates(Index facet, const Points& axes, SurfaceSegment& segment) const {
  const Points plane = segment.own_local;
  const auto in_plane = [&](const Vector& shift) { return Points(plane.colwise() - axes.transpose() * shift); };
  return map_.invert(facet, axes, in_plane(own_.shift()), segment.own_local) &&
         map_.invert(segment.opposite, axes, in_plane(opposite_.shift()), segment.opposite_local);
}

FacetSegments SegmentFinder::find(int facet, const Vector3& direction, bool any_depth) const {
  const View view(static_cast<int>(own_.shift().size()), direction);
  FacetSegments result;
  result.axes = view.axes();
  const FacetSurface::Facet& own = own_.facets()[std::size_t(facet)];
  double projected_area = 0.0;
  std::vector<Cut> cuts;
  for (int piece = own.first_piece; piece < own.first_piece + own.piece_count; ++piece) {
    cuts.clear();
    cut_piece(view, piece, any_depth, cuts);
    projected_area += view.flatten(own_.pieces()[std::size_t(piece)]).area;
    add_points(view, cuts, result.segments);
  }
  std::erase_if(result.segments, [](const SurfaceSegment& segment) { return segment.weights.size() == 0; });
  result.lost = Index(std::erase_if(
      result.segments, [&](SurfaceSegment& segment) { return !find_coordinates(own.number, result.axes, segment); }));
  double faced = 0.0;
  for (const SurfaceSegment& segment : result.segments) faced += segment.weights.sum();
  result.covered = projected_area > 0.0 ? faced / projected_area : 0.0;
  return result;
}

/// Calls visit(number, piece, its projection) for opposite pieces near a point of the plane that are not seen edge-on.
template <class Visit>
void SegmentFinder::visit_pieces_at(const View& view, const PlanePoint& at, double beyond, const Visit& visit) const {
  const auto may_face = [&](const BoxTree::Box& box) {
    const double rim = beyond * box.sizes().maxCoeff();
    return overlaps(box, view.first, at[0] - rim, at[0] + rim) &&
           (view.plane || overlaps(box, view.second, at[1] - rim, at[1] + rim));
  };
  opposite_.tree().visit(may_face, [&](int number) {
    const FacetSurface::Piece& piece = opposite_.pieces()[std::size_t(number)];
    if (view.direction.dot(piece.normal) >= edge_on) visit(number, piece, view.flatten(piece));
  });
}

SegmentFinder::Hit SegmentFinder::find_point(const Vector3& point, const Vector3& direction, double reach,
                                             double beyond, const std::vector<int>& ignored_facets) const {
  const View view(static_cast<int>(own_.shift().size()), direction);
  const PlanePoint at = view.project(point);
  const double height = direction.dot(point);
  Hit best;
  int best_piece = -1;
  visit_pieces_at(view, at, beyond, [&](int number, const FacetSurface::Piece& piece, const ProjectedPiece& flat) {
    const double gap = height - flat.height_at(at);
    if (gap < -reach || is_among(ignored_facets, piece.facet) || !flat.covers(at, view.plane, beyond)) return;
    const bool is_nearer = best_piece < 0 || std::abs(gap) < std::abs(best.gap) ||
                           (std::abs(gap) == std::abs(best.gap) && number < best_piece);
    if (!is_nearer) return;
    best.facet = opposite_.facets()[std::size_t(piece.facet)].number;
    best.gap = gap;
    best_piece = number;
  });
  if (best.facet < 0) return best;
  const Points axes = view.axes(), plane = at.head(axes.cols()) - axes.transpose() * opposite_.shift();
  Points position;
  if (!map_.invert(best.facet, axes, plane, best.local)) return {};
  map_.positions(best.facet, best.local, position);
  best.gap = height - direction.head(axes.rows()).dot(position.col(0) + opposite_.shift());
  return best;
}

double SegmentFinder::thickness_behind(int facet) const {
  const FacetSurface::Facet& own = own_.facets()[std::size_t(facet)];
  const Vector3 direction = -own.area_vector.normalized();
  const View view(static_cast<int>(own_.shift().size()), direction);
  const PlanePoint at = view.project(own.centre);
  const double height = direction.dot(own.centre);
  double nearest = std::numeric_limits<double>::infinity();
  visit_pieces_at(view, at, on_rim, [&](int, const FacetSurface::Piece&, const ProjectedPiece& flat) {
    const double behind = flat.height_at(at) - height;
    if (behind > 0.0 && flat.covers(at, view.plane, on_rim)) nearest = std::min(nearest, behind);
  });
  return nearest;
}

}  // namespace ricochet
