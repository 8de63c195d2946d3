#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/rigid/obstacle_shape.hpp"
#include "ricochet/rigid/surface/rigid_surface.hpp"

namespace ricochet {

namespace {

using Vector3 = RigidSurface::Vector3;

/// Default radius as a fraction of the distance between contact nodes: contact cannot resolve smaller features.
constexpr double part_of_spacing = 0.25;
/// A shorter derivative, as in a plate thinner than the radius, has no reliable direction.
constexpr double least_length = 0.1;
/// Number of facets of a picture.
constexpr std::size_t most_shown = 6000;
constexpr double most_of_reach = 6.0;

Vector3 in_three(const SpaceVector& point) {
  Vector3 result = Vector3::Zero();
  result.head(point.size()) = point;
  return result;
}

/// A body from a file. With a radius, the gap near the surface is the mean height above the facets within that radius
/// (RigidSurface::mean_height): its derivative, the normal, varies continuously around edges and in corners. The gap is
/// exact on faces and rounds edges: at a right-angled one the error is at most 15 % of the radius. Farther away than
/// the radius, and without one, it is the exact distance.
class Surface final : public ObstacleShape {
 public:
  Surface(RigidSurface surface, double side, std::optional<double> radius, std::string checksum, std::string file)
      : surface_(std::move(surface)),
        side_(side),
        given_radius_(radius),
        checksum_(std::move(checksum)),
        file_(std::move(file)) {
    if (given_radius_) radius_ = *given_radius_;
  }

  [[nodiscard]] double gap(const SpaceVector& position) const override { return evaluate(in_three(position)).gap; }
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const override {
    const Vector3 unit = evaluate(in_three(position)).gradient.normalized();
    return unit.head(position.size());
  }
  [[nodiscard]] SpaceVector gradient(const SpaceVector& position) const override {
    return evaluate(in_three(position)).gradient.head(position.size());
  }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    const BoxTree::Box box = surface_.box();
    return eight_roundings(position.lpNorm<1>() + box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).lpNorm<1>());
  }
  [[nodiscard]] SpaceVector centre() const override { return SpaceVector::Zero(surface_.in_space() ? 3 : 2); }
  [[nodiscard]] std::optional<Solid> solid() const override {
    if (side_ < 0.0 || !surface_.is_closed()) return std::nullopt;
    const RigidSurface::Moments moments = surface_.moments();
    const Index d = surface_.in_space() ? 3 : 2;
    // ∫ (|r|² 1 − r rᵀ); in the plane its last entry.
    const Eigen::Matrix3d inertia = moments.second.trace() * Eigen::Matrix3d::Identity() - moments.second;
    return Solid{moments.volume, moments.centre.head(d),
                 d == 3 ? Matrix(inertia) : Matrix(inertia.bottomRightCorner(1, 1))};
  }
  void fit(const ContactScale& scale) override {
    if (!given_radius_) radius_ = std::min(part_of_spacing * scale.spacing, surface_.width_of_smooth());
    if (!surface_.is_closed()) return;
    const Vector3 sides = surface_.block_sides();
    const double width = surface_.in_space() ? sides[1] : sides[2], least = surface_.in_space() ? sides[0] : sides[1];
    if (width < scale.spacing) {
      log::warning(
          fmt::format("{}: the surface is about {:.3g} wide, and nodes that may touch it are {:.3g} apart: it can pass "
                      "between them undetected; use smaller cells there",
                      file_, width, scale.spacing));
    }
    if (given_radius_ && 2.0 * radius_ > least) {
      log::warning(
          fmt::format("{}: edges are rounded over {:.3g}, more than half of the thickness of the surface, about "
                      "{:.3g}: gaps are wrong by a fraction of that; use a smaller edge_radius",
                      file_, radius_, least));
    }
  }
  [[nodiscard]] std::string remarks() const override {
    return radius_ > 0.0 ? fmt::format("its edges are rounded over a radius of {:.3g}", radius_)
                         : std::string("its edges are sharp: normals jump there");
  }
  [[nodiscard]] std::string checksum() const override { return checksum_; }
  [[nodiscard]] ObstacleSurface surface(const Vector& centre, double radius) const override;

 private:
  struct GapAndGradient {
    double gap;
    Vector3 gradient;
  };
  [[nodiscard]] GapAndGradient evaluate(const Vector3& at) const {
    const RigidSurface::Foot foot = surface_.nearest(at);
    const GapAndGradient exact = evaluate_exact(at, foot);
    const double distance = std::abs(exact.gap) / radius_;
    if (!(distance < 1.0) || foot.on_border) return exact;
    const RigidSurface::Height mean = surface_.mean_height(at, radius_);
    if (!(mean.weight > 0.0)) return exact;
    // The mean alone up to half the radius, then a smooth transition to the exact distance.
    const double t = std::max(2.0 * distance - 1.0, 0.0);
    const double part = t * t * (3.0 - 2.0 * t), slope = 12.0 * t * (1.0 - t) / radius_;
    const double height = side_ * mean.value;
    const double away = exact.gap < 0.0 ? -1.0 : 1.0;
    const Vector3 blended = (1.0 - part) * side_ * mean.gradient + part * exact.gradient +
                            slope * away * (exact.gap - height) * exact.gradient;
    if (!(blended.norm() > least_length)) return exact;
    return {(1.0 - part) * height + part * exact.gap, blended};
  }
  /// Beyond a border the surface bends away from the bodies as a quarter of a tube of the radius R: with the distance s
  /// along the surface and the height z above it the gap is √(s² + (R + z)²) − R, which is z at the border itself.
  /// Below the tube, z < −R, it ends in a wall, with the gap s − R: the obstacle is everything behind the surface, and
  /// a point that came in from the side would be deep inside at once.
  [[nodiscard]] GapAndGradient beyond_border(const Vector3& away, double along, const Vector3& normal) const {
    const Vector3 aside = away - along * normal;
    const Vector3 from_axis = along > -radius_ ? Vector3(away + radius_ * normal) : aside;
    const double length = from_axis.norm();
    return {length - radius_, length > 0.0 ? Vector3(from_axis / length) : normal};
  }
  /// Returns the distance and its derivative: the direction towards the point, or the normal of the edge if the two are
  /// too near to distinguish; beyond a border those of its rounding.
  [[nodiscard]] GapAndGradient evaluate_exact(const Vector3& at, const RigidSurface::Foot& foot) const {
    const Vector3 away = at - foot.position;
    const double along = away.dot(foot.normal), distance = away.norm();
    if (foot.on_facet) return {side_ * along, side_ * foot.normal};
    constexpr double near = 1e-10;
    const Vector3 size = at.cwiseAbs() + foot.position.cwiseAbs();
    if (distance <= near * size.maxCoeff()) return {side_ * (along < 0.0 ? -distance : distance), side_ * foot.normal};
    if (foot.on_border) return beyond_border(away, along, foot.normal);
    const double sign = along < 0.0 ? -side_ : side_;
    return {sign * distance, sign / distance * away};
  }

  RigidSurface surface_;
  double side_;
  std::optional<double> given_radius_;
  double radius_ = 0.0;
  std::string checksum_;
  std::string file_;  ///< for messages
};

/// Shows some facets of a surface. With width 0 all corners are kept; otherwise those within one cell of a grid of that
/// width are merged at their mean.
ObstacleSurface picture_of(const RigidSurface& surface, const std::vector<int>& facets, double width, double side) {
  std::map<std::array<long, 3>, int> numbers;
  std::vector<Vector3> sums;
  std::vector<int> counts;
  std::map<int, int> number_of;  // of each corner
  const auto point_of = [&](int corner) {
    const auto [point, is_new] = number_of.try_emplace(corner, 0);
    if (!is_new) return point->second;
    const Vector3& at = surface.corners()[std::size_t(corner)];
    std::array<long, 3> key{corner, -1, -1};
    if (width > 0.0) {
      for (std::size_t k = 0; k < 3; ++k) key[k] = long(std::floor((at - surface.box().min())[Index(k)] / width));
    }
    const auto [entry, added] = numbers.try_emplace(key, int(sums.size()));
    if (added) {
      sums.push_back(Vector3::Zero());
      counts.push_back(0);
    }
    sums[std::size_t(entry->second)] += at;
    ++counts[std::size_t(entry->second)];
    return point->second = entry->second;
  };
  ObstacleSurface result;
  std::map<std::array<int, 3>, char> shown;
  for (const int facet : facets) {
    std::array<int, 3> own = surface.facets()[std::size_t(facet)];
    for (int& corner : own) corner = point_of(corner);
    if (surface.in_space() && (own[1] == own[2] || own[2] == own[0])) continue;
    if (own[0] == own[1]) continue;
    std::array<int, 3> key = own;  // identifies a facet independently of its first corner
    if (surface.in_space()) std::rotate(key.begin(), std::ranges::min_element(key), key.end());
    if (width > 0.0 && !shown.try_emplace(key, 1).second) continue;
    if (side < 0.0) std::swap(own[0], own[1]);
    result.cells.insert(result.cells.end(), own.begin(), own.begin() + (surface.in_space() ? 3 : 2));
    if (surface.in_space()) result.cells.push_back(own[2]);
  }
  const Index d = surface.in_space() ? 3 : 2;
  result.points.resize(d, Index(sums.size()));
  for (std::size_t k = 0; k < sums.size(); ++k) result.points.col(Index(k)) = (sums[k] / counts[k]).head(d);
  return result;
}

/// Shows the nearby facets; if they are too many, coarsened no more than necessary, so that features that protrude from
/// a plate remain visible.
ObstacleSurface Surface::surface(const Vector& centre, double radius) const {
  const Vector3 middle = in_three(SpaceVector(centre));
  const double reach = radius + std::abs(gap(SpaceVector(centre)));
  // A surface that is not much larger is shown whole.
  const bool is_small = surface_.box().diagonal().norm() < most_of_reach * reach;
  std::vector<int> shown;
  surface_.tree().visit([&](const BoxTree::Box& box) { return is_small || box.exteriorDistance(middle) < reach; },
                        [&](int facet) { shown.push_back(facet); });
  std::ranges::sort(shown);
  constexpr double coarser = 1.2;
  const std::size_t corners = surface_.in_space() ? 4 : 2;
  double width = 0.0;
  ObstacleSurface result = picture_of(surface_, shown, width, side_);
  while (result.cells.size() > corners * most_shown) {
    width = width == 0.0 ? 0.5 * reach / std::sqrt(double(shown.size())) : coarser * width;
    result = picture_of(surface_, shown, width, side_);
  }
  return result;
}

std::vector<Key> surface_keys() {
  return {
      typed_key(
          "file", KeyType::text, "", required(),
          "The surface: an STL file, binary or ASCII, whose triangles are counterclockwise seen from outside; in "
          "two dimensions a text file with x and y of a corner of a polygon in each line, the obstacle to the "
          "right of the polygon's sides, and an empty line between polygons. The obstacle is the enclosed region; "
          "if the surface has a border, the obstacle is everything that faces it from behind."),
      number_key("scale", "1", {.default_value = "1", .range = positive},
                 "Factor for all coordinates of the file: 1e-3 for millimetres in a case in metres."),
      number_key(
          "edge_radius", "length", {.range = nonnegative},
          "Gaps and normals are means over the facets within this distance, which rounds edges; 0: edges are "
          "sharp, and normals jump there. Absent: a quarter of the largest distance between nodes of the contacts "
          "with it, but at most the width of its facets if the surface bends by at most 30 degrees at every edge."),
      obstacle_side_key("Side of the bodies: \"outside\" the region that the surface encloses, or \"inside\" it; the "
                        "surface must then be closed.")};
}

void log_repairs(const RigidSurface& surface, const std::string& file) {
  const char* const noun = surface.in_space() ? "triangle" : "segment";
  if (surface.was_reversed())
    log::warning(
        fmt::format("{}: the surface was inside out, its normals pointing inwards; all {}s were reversed", file, noun));
  if (surface.joined_count() > 0)
    log::info(
        fmt::format("{}: {} corners at borders are within a millionth of the surface's size of other corners: they are "
                    "merged with these, which closes the border there",
                    file, surface.joined_count()));
  if (surface.flat_count() > 0)
    log::info(fmt::format("{}: {} {}s without {} make contact only through their neighbours", file,
                          surface.flat_count(), noun, surface.in_space() ? "an area" : "a length"));
  if (surface.is_closed()) return;
  const Vector3& position = surface.border_position();
  log::info(
      fmt::format("{}: the surface is not closed: {} {} to only one {}, one of them at ({:.4g}, {:.4g}, {:.4g}); "
                  "everything behind it counts as inside the obstacle",
                  file, surface.border_count(), surface.in_space() ? "edges belong" : "corners belong", noun,
                  position[0], position[1], position[2]));
}

}  // namespace

ObstacleRegistration surface_obstacle() {
  const auto make = [](const Parameters& parameters) {
    const std::string& file = parameters.text("file");
    const double scale = parameters.number("scale"), side = obstacle_side(parameters);
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    RigidSurface surface(extension == ".stl" ? read_stl(file, scale) : read_polygons(file, scale), file);
    if (side < 0.0 && !surface.is_closed()) {
      const Vector3& position = surface.border_position();
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("{}: bodies must be inside this surface, but it is not closed: {} of its {} belong to only "
                      "one {}, the first at ({:.6g}, {:.6g}, {:.6g}); close it, or set side = \"outside\"",
                      file, surface.border_count(), surface.in_space() ? "edges" : "corners",
                      surface.in_space() ? "triangle" : "segment", position[0], position[1], position[2]));
    }
    log_repairs(surface, file);
    std::optional<double> radius;
    if (parameters.has("edge_radius")) radius = parameters.number("edge_radius");
    Checksum sum;
    for (const Vector3& corner : surface.corners()) sum.add(corner.data(), 3);
    return std::make_unique<Surface>(std::move(surface), side, radius, sum.text(), file);
  };
  return {"surface", make, surface_keys()};
}

}  // namespace ricochet
