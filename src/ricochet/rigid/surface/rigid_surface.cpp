#include "ricochet/rigid/surface/rigid_surface.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ricochet/base/angles.hpp"
#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/point_sets.hpp"
#include "ricochet/mesh/disjoint_sets.hpp"
#include "ricochet/mesh/search/closest_point.hpp"

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;

/// Angle of a triangle at corner k.
double angle_at(const std::array<Vector3, 3>& corners, int k) {
  const Vector3& at = corners[std::size_t(k)];
  return angle_between(corners[std::size_t((k + 1) % 3)] - at, corners[std::size_t((k + 2) % 3)] - at);
}

}  // namespace

RigidSurface::RigidSurface(const SurfaceFacets& facets, const std::string& name) : in_space_(facets.in_space) {
  join_corners(facets);
  find_normals(name);
  find_edges(name);
  if (!is_closed() && join_borders()) {
    find_normals(name);
    find_edges(name);
  }
  if (is_closed() && volume() < 0.0) reverse_orientation();
  std::vector<BoxTree::Box> boxes(facets_.size());
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    for (int k = 0; k < corner_count(); ++k) boxes[i].extend(corner(i, k));
  }
  tree_ = BoxTree(boxes);
}

/// Merges corners at the same position.
void RigidSurface::join_corners(const SurfaceFacets& facets) {
  const auto per_facet = std::size_t(corner_count());
  std::vector<std::size_t> order(facets.corners.size() * per_facet);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto at = [&](std::size_t i) -> const Vector3& { return facets.corners[i / per_facet][i % per_facet]; };
  const auto before = [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(at(a).begin(), at(a).end(), at(b).begin(), at(b).end());
  };
  std::ranges::sort(order, before);
  facets_.resize(facets.corners.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || before(order[i - 1], order[i])) corners_.push_back(at(order[i]));
    facets_[order[i] / per_facet][order[i] % per_facet] = int(corners_.size()) - 1;
  }
  if (in_space_) return;
  for (std::array<int, 3>& facet : facets_) facet[2] = facet[1];
}

/// Merges border corners that rounding to seven digits may have separated.
bool RigidSurface::join_borders() {
  constexpr double near = 1e-6;  // relative to the size of the surface
  std::vector<int> order;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (corner_normals_[i].is_border) order.push_back(int(i));
  }
  const auto positions = Eigen::Map<const Points>(corners_.front().data(), 3, Index(corners_.size()));
  const double reach = near * enclosing_diameter(positions);
  // A direction along which few corners of usual surfaces have equal heights.
  const Vector3 direction = Vector3(0.6182, 0.5432, 0.5681).normalized();
  const auto at = [&](int corner) -> const Vector3& { return corners_[std::size_t(corner)]; };
  const auto height = [&](int corner) { return direction.dot(at(corner)); };
  std::ranges::sort(order, [&](int a, int b) { return std::pair(height(a), a) < std::pair(height(b), b); });
  DisjointSets sets(static_cast<Index>(corners_.size()));
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && height(order[j]) - height(order[i]) <= reach; ++j) {
      if (sets.root(order[i]) == sets.root(order[j]) || (at(order[i]) - at(order[j])).norm() > reach) continue;
      sets.join(order[i], order[j]);
      ++joined_count_;
    }
  }
  for (std::array<int, 3>& facet : facets_) {
    for (int& corner : facet) corner = int(sets.root(corner));
  }
  return joined_count_ > 0;
}

void RigidSurface::find_normals(const std::string& name) {
  normals_.resize(facets_.size());
  flat_count_ = 0;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const Vector3 a = corner(i, 1) - corner(i, 0);
    const Vector3 normal = in_space_ ? Vector3(a.cross(corner(i, 2) - corner(i, 0))) : Vector3(-a[1], a[0], 0.0);
    const double length = normal.stableNorm(),
                 size = std::max(a.squaredNorm(), (corner(i, 2) - corner(i, 0)).squaredNorm());
    constexpr double least = 1e-12;
    const bool is_flat = in_space_ ? length <= least * size : length == 0.0;
    normals_[i] = is_flat ? Vector3(Vector3::Zero()) : Vector3(normal / length);
    flat_count_ += is_flat ? 1 : 0;
  }
  if (flat_count_ == long(facets_.size()))
    throw Error(ErrorKind::invalid_input, fmt::format("{}: no {} has {}", name, in_space_ ? "triangle" : "segment",
                                                      in_space_ ? "an area" : "a length"));
}

std::string RigidSurface::position_text(const Vector3& position) const {
  return in_space_ ? fmt::format("({:.6g}, {:.6g}, {:.6g})", position[0], position[1], position[2])
                   : fmt::format("({:.6g}, {:.6g})", position[0], position[1]);
}

std::string RigidSurface::text_of(int facet) const {
  const auto i = std::size_t(facet);
  const Vector3 middle = in_space_ ? Vector3((corner(i, 0) + corner(i, 1) + corner(i, 2)) / 3.0)
                                   : Vector3(0.5 * (corner(i, 0) + corner(i, 1)));
  return fmt::format("{} {} at {}", in_space_ ? "triangle" : "segment", facet + 1, position_text(middle));
}

/// Accepts one facet, or two that traverse the edge in opposite directions. In the plane corners take the role of
/// edges.
void RigidSurface::check_edge(std::span<const Side> sides, const std::string& name) const {
  if (sides.size() == 1 || (sides.size() == 2 && sides[0].forward != sides[1].forward)) return;
  const auto sorted = [&](const Side& side) {
    std::array<int, 3> corners = facets_[std::size_t(side.facet)];
    std::ranges::sort(corners);
    return corners;
  };
  for (std::size_t k = 1; k < sides.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      if (sorted(sides[k]) == sorted(sides[l]))
        throw Error(ErrorKind::invalid_input, fmt::format("{}: {} and {} are identical: remove one of them", name,
                                                          text_of(sides[l].facet), text_of(sides[k].facet)));
    }
  }
  if (sides.size() == 2)
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: {} and {} are neighbours with opposite orientations: reverse one of them, so that "
                            "normals point out of the obstacle everywhere",
                            name, text_of(sides[0].facet), text_of(sides[1].facet)));
  throw Error(ErrorKind::invalid_input,
              fmt::format("{}: {} {}s meet at the {} at {}, {} among them; where more than two meet, the surface has "
                          "no inside: separate the bodies that touch there",
                          name, sides.size(), in_space_ ? "triangle" : "segment", in_space_ ? "edge" : "corner",
                          position_text(middle_of(sides[0])), text_of(sides[0].facet)));
}

RigidSurface::Vector3 RigidSurface::middle_of(const Side& side) const {
  return 0.5 * (corners_[std::size_t(side.low)] + corners_[std::size_t(side.high)]);
}

/// Returns the sides sorted by their corners. A facet with two coincident corners contributes none: its other two sides
/// are neighbours of each other.
std::vector<RigidSurface::Side> RigidSurface::sorted_sides() const {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const std::array<int, 3>& facet = facets_[i];
    if (facet[0] == facet[1] || (in_space_ && (facet[1] == facet[2] || facet[2] == facet[0]))) continue;
    for (int k = 0; k < corner_count(); ++k) {
      const int a = facet[std::size_t(k)], b = in_space_ ? facet[std::size_t((k + 1) % 3)] : a;
      sides.push_back({std::min(a, b), std::max(a, b), int(i), k, in_space_ ? a < b : k == 0});
    }
  }
  std::ranges::sort(sides, [](const Side& a, const Side& b) {
    return std::array{a.low, a.high, a.facet} < std::array{b.low, b.high, b.facet};
  });
  return sides;
}

void RigidSurface::find_edges(const std::string& name) {
  const std::vector<Side> sides = sorted_sides();
  edges_.clear();
  edge_of_.assign(facets_.size(), {-1, -1, -1});
  border_count_ = 0;
  bent_width_ = bent_count_ = 0.0;
  least_cosine_ = 1.0;
  corner_normals_.assign(corners_.size(), {});
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].low == sides[first].low && sides[last].high == sides[first].high) ++last;
    const std::span<const Side> here(sides.data() + first, last - first);
    check_edge(here, name);
    Edge edge;
    for (const Side& side : here) {
      edge.normal += normals_[std::size_t(side.facet)];
      edge_of_[std::size_t(side.facet)][std::size_t(side.number)] = int(edges_.size());
    }
    if (edge.normal.norm() > 0.0) edge.normal.normalize();
    edge.is_border = here.size() == 1;
    if (!edge.is_border) {
      measure_bend(here);
    } else {
      if (border_count_++ == 0) border_position_ = middle_of(here[0]);
      corner_normals_[std::size_t(here[0].low)].is_border = true;
      corner_normals_[std::size_t(here[0].high)].is_border = true;
    }
    if (!in_space_) corner_normals_[std::size_t(here[0].low)].normal = edge.normal;
    edges_.push_back(edge);
  }
  if (in_space_) find_corner_normals();
}

/// Accumulates the width of the facets at edges that bend, and the sharpest bend.
void RigidSurface::measure_bend(std::span<const Side> sides) {
  const auto facet_of = [&](int k) { return std::size_t(sides[std::size_t(k)].facet); };
  const double cosine = normals_[facet_of(0)].dot(normals_[facet_of(1)]);
  constexpr double flat = 1e-12;
  if (cosine > 1.0 - flat || normals_[facet_of(0)].isZero(0.0) || normals_[facet_of(1)].isZero(0.0)) return;
  least_cosine_ = std::min(least_cosine_, cosine);
  for (const int k : {0, 1}) {
    const Vector3 a = corner(facet_of(k), 1) - corner(facet_of(k), 0);
    if (in_space_) {
      const double edge = (corners_[std::size_t(sides[0].high)] - corners_[std::size_t(sides[0].low)]).norm();
      bent_width_ += a.cross(corner(facet_of(k), 2) - corner(facet_of(k), 0)).norm() / edge;
    } else {
      bent_width_ += a.norm();
    }
    bent_count_ += 1.0;
  }
}

double RigidSurface::width_of_smooth() const {
  constexpr double sharp = 0.866;  // 30 degrees
  const bool is_smooth = bent_count_ > 0.0 && least_cosine_ > sharp;
  return is_smooth ? bent_width_ / bent_count_ : std::numeric_limits<double>::infinity();
}

/// Corner normals: those of the facets, weighted by their angles.
void RigidSurface::find_corner_normals() {
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      corner_normals_[std::size_t(facets_[i][std::size_t(k)])].normal +=
          angle_at({corner(i, 0), corner(i, 1), corner(i, 2)}, k) * normals_[i];
  }
  for (Edge& at : corner_normals_) {
    if (at.normal.norm() > 0.0) at.normal.normalize();
  }
}

void RigidSurface::reverse_orientation() {
  was_reversed_ = true;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    std::array<int, 3>& facet = facets_[i];
    if (in_space_) {
      std::swap(facet[0], facet[1]);
      std::swap(edge_of_[i][1], edge_of_[i][2]);
    } else {
      facet = {facet[1], facet[0], facet[0]};
      std::swap(edge_of_[i][0], edge_of_[i][1]);
    }
    normals_[i] = -normals_[i];
  }
  for (Edge& edge : edges_) edge.normal = -edge.normal;
  for (Edge& edge : corner_normals_) edge.normal = -edge.normal;
}

double RigidSurface::volume() const { return moments().volume; }

/// Sums over cones from the centre of the box to the facets, so that no accuracy is lost far from the origin. For a
/// tetrahedron (0, a, b, c), ∫ r rᵀ = V/20 (s sᵀ + a aᵀ + b bᵀ + c cᵀ) with s = a + b + c; for a triangle,
/// A/12 (s sᵀ + a aᵀ + b bᵀ).
RigidSurface::Moments RigidSurface::moments() const {
  BoxTree::Box box;
  for (const Vector3& point : corners_) box.extend(point);
  const Vector3 middle = box.center();
  Moments sum;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const Vector3 a = corner(i, 0) - middle, b = corner(i, 1) - middle;
    const Vector3 c = in_space_ ? Vector3(corner(i, 2) - middle) : Vector3(Vector3::Zero()), s = a + b + c;
    const double part = in_space_ ? a.dot(b.cross(c)) / 6.0 : -0.5 * (a[0] * b[1] - a[1] * b[0]);
    sum.volume += part;
    sum.centre += part / (in_space_ ? 4.0 : 3.0) * s;
    sum.second += part / (in_space_ ? 20.0 : 12.0) *
                  (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (sum.volume == 0.0) return sum;
  sum.centre /= sum.volume;
  sum.second -= sum.volume * sum.centre * sum.centre.transpose();
  sum.centre += middle;
  return sum;
}

RigidSurface::Vector3 RigidSurface::block_sides() const {
  const Moments sums = moments();
  if (sums.volume == 0.0) return Vector3::Zero();
  // For a block with sides a, b, c they are a²/12, b²/12, c²/12.
  return symmetric_eigenvalues(Eigen::Matrix3d(12.0 / sums.volume * sums.second)).cwiseMax(0.0).cwiseSqrt();
}

RigidSurface::Foot RigidSurface::nearest(const Vector3& point) const {
  double least = std::numeric_limits<double>::infinity();
  ClosestPoint closest;
  std::size_t at = 0;
  const auto look_at = [&](int facet) {
    const auto i = std::size_t(facet);
    const ClosestPoint found = in_space_ ? closest_on_triangle(point, corner(i, 0), corner(i, 1), corner(i, 2))
                                         : closest_on_segment(point, corner(i, 0), corner(i, 1));
    const double square = (found.position - point).squaredNorm();
    if (!(square < least)) return;
    least = square;
    closest = found;
    at = i;
  };
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  struct Waiting {
    int node;
    double square;
  };
  std::array<Waiting, BoxTree::max_depth> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, 0.0};
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (!(next.square < least)) continue;
    const BoxTree::Node& node = nodes[std::size_t(next.node)];
    for (int i = node.first; i < node.first + node.count; ++i) look_at(tree_.order()[std::size_t(i)]);
    if (node.count > 0) continue;
    const Waiting first{next.node + 1, nodes[std::size_t(next.node) + 1].box.squaredExteriorDistance(point)};
    const Waiting second{node.second, nodes[std::size_t(node.second)].box.squaredExteriorDistance(point)};
    const bool in_order = first.square <= second.square;
    waiting[count++] = in_order ? second : first;
    waiting[count++] = in_order ? first : second;
  }
  const int touched = int(std::ranges::count_if(closest.corners, [](int corner) { return corner >= 0; }));
  if (touched == corner_count()) return {closest.position, normals_[at], true, false};
  if (touched == 2) {
    const int a = closest.corners[0], b = closest.corners[1];
    const int side = a + 1 == b ? a : 2;
    const Edge& edge = edges_[std::size_t(edge_of_[at][std::size_t(side)])];
    return {closest.position, edge.normal, false, edge.is_border};
  }
  const Edge& edge = corner_normals_[std::size_t(facets_[at][std::size_t(closest.corners[0])])];
  return {closest.position, edge.normal, false, edge.is_border};
}

FacetWeight RigidSurface::weight_near(std::size_t facet, const Vector3& at, double radius) const {
  return in_space_
             ? weight_of_triangle({corner(facet, 0), corner(facet, 1), corner(facet, 2)}, normals_[facet], at, radius)
             : weight_of_segment(corner(facet, 0), corner(facet, 1), at, radius);
}

RigidSurface::Height RigidSurface::mean_height(const Vector3& point, double radius) const {
  double heights = 0.0;
  Height sum;
  Vector3 gradient_sum = Vector3::Zero(), weights = Vector3::Zero();  // Σ h ∇w + w N, Σ ∇w
  const double square = radius * radius;
  tree_.visit([&](const BoxTree::Box& box) { return box.squaredExteriorDistance(point) < square; },
              [&](int facet) {
                const auto i = std::size_t(facet);
                if (normals_[i].isZero(0.0)) return;
                const FacetWeight weight = weight_near(i, point, radius);
                if (weight.value == 0.0) return;
                const double height = normals_[i].dot(point - corner(i, 0));
                heights += weight.value * height;
                sum.weight += weight.value;
                gradient_sum += height * weight.gradient + weight.value * normals_[i];
                weights += weight.gradient;
              });
  if (!(sum.weight > 0.0)) return sum;
  sum.value = heights / sum.weight;
  sum.gradient = (gradient_sum - sum.value * weights) / sum.weight;
  return sum;
}

}  // namespace ricochet
