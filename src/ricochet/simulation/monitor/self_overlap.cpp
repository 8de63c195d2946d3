#include "ricochet/simulation/monitor/self_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;

/// Relative tolerance by which a ray may miss a piece, and within which two positions on it coincide.
constexpr double rounding_of_rays = 1e-9;
/// Minimum cosine between a ray and the normals of the node's own pieces.
constexpr double least_lead = 0.02;
/// Maximum cosine between the normals of a node and of the surface through which it has passed: sides of a body next to
/// the node do not face it.
constexpr double most_facing = -0.3;
/// Slope of the two rays beside the normal one.
constexpr double slant = 0.3;

/// Returns whether a ray meets a box within a distance, in lengths of the direction.
bool meets_box(const Eigen::AlignedBox3d& box, const Vector3& from, const Vector3& along, double distance, double pad) {
  double first = 0.0, last = distance;
  for (Index k = 0; k < 3; ++k) {
    const double low = box.min()[k] - pad - from[k], high = box.max()[k] + pad - from[k];
    if (along[k] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double one = low / along[k], other = high / along[k];
    first = std::max(first, std::min(one, other));
    last = std::min(last, std::max(one, other));
  }
  return first <= last;
}

bool is_in_segment(const Vector3& point, const Vector3& a, const Vector3& b) {
  const Vector3 along = b - a;
  const double at = along.dot(point - a) / along.squaredNorm();
  return at >= -rounding_of_rays && at <= 1.0 + rounding_of_rays;
}

/// `area`: vector of twice the triangle's area.
bool is_in_triangle(const Vector3& point, const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& area) {
  const double least = -rounding_of_rays * area.squaredNorm();
  return (b - a).cross(point - a).dot(area) >= least && (c - b).cross(point - b).dot(area) >= least &&
         (a - c).cross(point - c).dot(area) >= least;
}

bool has_corner(const BodySurface::Corners& corners, int node) {
  return std::ranges::find(corners, node) != corners.end();
}

Vector3 mirrored(const Vector3& vector) { return {-vector[0], vector[1], vector[2]}; }

}  // namespace

double SelfOverlap::opening(int node) const {
  const Vector3 normal = surface_.normal_at(node).normalized();
  double least = 1.0;
  for (const int piece : surface_.around(node)) least = std::min(least, surface_.normal_of(piece).dot(normal));
  return least;
}

std::optional<SelfOverlap::Found> SelfOverlap::at(int node, double* clearance) const {
  const Vector3 normal = surface_.normal_at(node).normalized();
  const Hit along = leads_out(node, normal) ? first_hit(node, normal) : Hit{std::numeric_limits<double>::infinity()};
  if (clearance != nullptr) *clearance = along.side > 0 ? along.distance : std::numeric_limits<double>::infinity();
  if (along.side >= 0) return {};
  double way = along.distance;
  const Vector3 across = surface_.is_plane() ? Vector3(-normal[1], normal[0], 0.0) : normal.unitOrthogonal();
  for (const double side : {slant, -slant}) {
    const Vector3 direction = normal + side * across;
    if (!leads_out(node, direction)) continue;
    way = std::min(way, way_inside(node, direction));
    if (way < 0.0) return {};
  }
  const Vector3& position = surface_.at(node);
  const BodySurface::Closest through = surface_.closest_of(position, [&](int piece, const Vector3& closest) {
    if (has_corner(surface_.pieces()[std::size_t(piece)], node)) return false;
    const Vector3 facing = surface_.normal_of(piece);
    return facing.dot(normal) < most_facing && facing.dot(position - closest) <= 0.0;
  });
  if (through.piece < 0) return {};
  Found found{std::min(way, std::sqrt(through.squared_distance)), -1, through.piece};
  const Vector3 facing = surface_.normal_of(through.piece);
  double most = std::numeric_limits<double>::infinity();
  for (const int piece : surface_.around(node)) {
    const double cosine = surface_.normal_of(piece).dot(facing);
    if (cosine >= most) continue;
    most = cosine;
    found.own_piece = piece;
  }
  return found;
}

bool SelfOverlap::leads_out(int node, const Vector3& direction) const {
  const std::span<const int> around = surface_.around(node);
  const double least = least_lead * direction.norm();
  return std::ranges::all_of(around, [&](int piece) { return surface_.normal_of(piece).dot(direction) > least; });
}

/// With a mirror image, a ray beyond the axis passes through the image, as its own image passes through the surface.
SelfOverlap::Hit SelfOverlap::first_hit(int node, const Vector3& direction) const {
  Hit first{std::numeric_limits<double>::infinity()};
  const Vector3& from = surface_.at(node);
  trace(from, direction, node, first);
  // On the axis a node is its own image. Elsewhere the image's pieces around it obstruct the ray like any others.
  const int own = from[0] <= rounding_of_rays * surface_.tree().nodes().front().box.max()[0] ? node : -1;
  if (mirrored_) trace(mirrored(from), mirrored(direction), own, first);
  return first;
}

double SelfOverlap::way_inside(int node, const Vector3& direction) const {
  const Hit first = first_hit(node, direction);
  return first.side < 0 ? first.distance * direction.norm() : -1.0;
}

void SelfOverlap::trace(const Vector3& from, const Vector3& along, int node, Hit& first) const {
  const std::vector<BoxTree::Node>& nodes = surface_.tree().nodes();
  const double same = rounding_of_rays * nodes.front().box.diagonal().norm();
  std::array<int, BoxTree::max_depth> waiting{};
  std::size_t count = 1;
  while (count > 0) {
    const int number = waiting[--count];
    const BoxTree::Node& box = nodes[std::size_t(number)];
    if (!meets_box(box.box, from, along, first.distance + same, same)) continue;
    for (int i = box.first; i < box.first + box.count; ++i) {
      const int piece = surface_.tree().order()[std::size_t(i)];
      if (!has_corner(surface_.pieces()[std::size_t(piece)], node)) meet(from, along, piece, same, first);
    }
    if (box.count > 0) continue;
    waiting[count++] = box.second;
    waiting[count++] = number + 1;
  }
}

/// `same`: distance within which positions coincide.
void SelfOverlap::meet(const Vector3& from, const Vector3& along, int piece, double same, Hit& first) const {
  const BodySurface::Corners& corners = surface_.pieces()[std::size_t(piece)];
  const Vector3 &a = surface_.at(corners[0]), &b = surface_.at(corners[1]);
  const bool plane = surface_.is_plane();
  const Vector3& c = plane ? b : surface_.at(corners[2]);
  const Vector3 area = plane ? Vector3((b - a)[1], -(b - a)[0], 0.0) : Vector3((b - a).cross(c - a));
  const double slope = area.dot(along);
  if (!(std::abs(slope) > rounding_of_rays * area.norm())) return;
  const double distance = area.dot(a - from) / slope;
  if (!(distance >= 0.0) || distance > first.distance + same) return;
  const Vector3 intersection = from + distance * along;
  if (!(plane ? is_in_segment(intersection, a, b) : is_in_triangle(intersection, a, b, c, area))) return;
  const int side = slope < 0.0 ? 1 : -1;
  if (distance < first.distance - same || !std::isfinite(first.distance)) {
    first = {distance, side};
  } else {
    if (side != first.side) first.side = 0;
    first.distance = std::min(first.distance, distance);
  }
}

}  // namespace ricochet
