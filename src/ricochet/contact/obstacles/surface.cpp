#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/contact/obstacle_shape.hpp"
#include "ricochet/contact/surface/rigid_surface.hpp"

namespace ricochet {

namespace {

using Three = RigidSurface::Three;

/// Where a case gives no radius, normals are means over this part of the distance between contact nodes: what is
/// smaller than that distance contact does not see.
constexpr double part_of_spacing = 0.25;
/// Facets of a picture.
constexpr std::size_t most_shown = 6000;

Three in_three(const SpaceVector& point) {
  Three result = Three::Zero();
  result.head(point.size()) = point;
  return result;
}

/// A body from a file. The gap is the exact distance to its facets; the normal is their mean over a radius (see
/// RigidSurface::mean_normal), so that it is continuous along the surface. The gap's own derivative jumps at edges;
/// the normal of a step has what is missing (ObstacleShape::normal_of_step), and creates no energy there.
class Surface final : public ObstacleShape {
 public:
  Surface(RigidSurface surface, double side, std::optional<double> radius, std::string checksum)
      : surface_(std::move(surface)), side_(side), given_radius_(radius), checksum_(std::move(checksum)) {
    if (given_radius_) radius_ = *given_radius_;
  }

  [[nodiscard]] double gap(const SpaceVector& position) const override {
    const Three at = in_three(position);
    const RigidSurface::Foot foot = surface_.nearest(at);
    return signed_distance(at, foot);
  }
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const override {
    const Three at = in_three(position);
    const RigidSurface::Foot foot = surface_.nearest(at);
    const Three own = own_normal(at, foot);
    const Three result = radius_ > 0.0 ? averaged(at, foot, own) : own;
    return side_ * result.head(position.size());
  }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    const BoxTree::Box box = surface_.box();
    return eight_roundings(position.lpNorm<1>() + box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).lpNorm<1>());
  }
  [[nodiscard]] SpaceVector centre() const override { return SpaceVector::Zero(surface_.in_space() ? 3 : 2); }
  void fit(const ContactScale& scale) override {
    if (!given_radius_) radius_ = part_of_spacing * scale.spacing;
  }
  [[nodiscard]] std::string remarks() const override {
    return radius_ > 0.0 ? fmt::format("its normals are means over a radius of {:.3g}", radius_)
                         : std::string("its normals are those of its facets, and jump at edges");
  }
  [[nodiscard]] std::string checksum() const override { return checksum_; }
  [[nodiscard]] ObstacleSurface surface(const Vector& centre, double radius) const override;

 private:
  [[nodiscard]] double signed_distance(const Three& at, const RigidSurface::Foot& foot) const {
    const Three away = at - foot.position;
    const double along = away.dot(foot.normal);
    if (foot.on_facet) return side_ * along;
    const double distance = away.norm();
    if (foot.on_border && distance > 0.0 && std::abs(along) < distance) return distance;
    return side_ * (along < 0.0 ? -distance : distance);
  }
  /// The derivative of the distance: towards the point, or that of the edge where the two are too near to tell.
  [[nodiscard]] Three own_normal(const Three& at, const RigidSurface::Foot& foot) const {
    if (foot.on_facet) return foot.normal;
    const Three away = at - foot.position;
    const double distance = away.norm();
    constexpr double near = 1e-7;
    const Three size = at.cwiseAbs() + foot.position.cwiseAbs();
    if (distance <= near * size.maxCoeff()) return foot.normal;
    return (away.dot(foot.normal) < 0.0 ? -1.0 : 1.0) / distance * away;
  }
  /// On the surface the mean, as far away as the radius the gap's derivative.
  [[nodiscard]] Three averaged(const Three& at, const RigidSurface::Foot& foot, const Three& own) const {
    const double part = std::min((at - foot.position).norm() / radius_, 1.0);
    if (part == 1.0) return own;
    const Three mean = (1.0 - part) * surface_.mean_normal(foot.position, radius_, foot.normal) + part * own;
    const double length = mean.norm();
    return length > 0.5 ? Three(mean / length) : own;
  }

  RigidSurface surface_;
  double side_;
  std::optional<double> given_radius_;
  double radius_ = 0.0;
  std::string checksum_;
};

/// Of facets that are near; where they are too many, corners in one cell of a grid become one.
ObstacleSurface Surface::surface(const Vector& centre, double radius) const {
  const Three middle = in_three(SpaceVector(centre));
  const double reach = radius + std::abs(gap(SpaceVector(centre)));
  const auto& facets = surface_.facets();
  const auto& corners = surface_.corners();
  std::vector<int> shown;
  surface_.tree().visit([&](const BoxTree::Box& box) { return box.exteriorDistance(middle) < reach; },
                        [&](int facet) { shown.push_back(facet); });
  std::sort(shown.begin(), shown.end());
  const double cell = shown.size() > most_shown ? 2.0 * reach / std::sqrt(0.1 * static_cast<double>(most_shown)) : 0.0;
  std::map<std::array<long, 3>, int> numbers;
  std::vector<Three> points;
  const auto point_of = [&](int corner) {
    const Three& at = corners[static_cast<std::size_t>(corner)];
    std::array<long, 3> key{corner, -1, -1};
    if (cell > 0.0) {
      for (std::size_t k = 0; k < 3; ++k) key[k] = std::lround(at[static_cast<Index>(k)] / cell);
    }
    const auto [entry, added] = numbers.try_emplace(key, static_cast<int>(points.size()));
    if (added) points.push_back(at);
    return entry->second;
  };
  ObstacleSurface result;
  std::map<std::array<int, 3>, char> known;
  for (const int facet : shown) {
    std::array<int, 3> own = facets[static_cast<std::size_t>(facet)];
    for (int& corner : own) corner = point_of(corner);
    if (surface_.in_space() && (own[0] == own[1] || own[1] == own[2] || own[2] == own[0])) continue;
    if (cell > 0.0 && !known.try_emplace(own, 1).second) continue;
    if (side_ < 0.0) std::swap(own[0], own[1]);
    result.cells.insert(result.cells.end(), own.begin(), own.begin() + (surface_.in_space() ? 3 : 2));
    if (surface_.in_space()) result.cells.push_back(own[2]);
  }
  const Index d = surface_.in_space() ? 3 : 2;
  result.points.resize(d, static_cast<Index>(points.size()));
  for (Index k = 0; k < result.points.cols(); ++k) result.points.col(k) = points[static_cast<std::size_t>(k)].head(d);
  return result;
}

std::vector<Key> surface_keys() {
  return {
      {.name = "file",
       .type = KeyType::text,
       .required = true,
       .doc = "The surface: STL, binary or ASCII, whose triangles turn counterclockwise seen from outside; in two "
              "dimensions a text file with x and y of a corner of a polygon in each line, the obstacle to the right "
              "of its lines, an empty line between polygons. What it encloses is the obstacle; behind one with a "
              "border, everything is that faces it from behind."},
      {.name = "scale",
       .type = KeyType::number,
       .unit = "1",
       .standard = "1",
       .range = positive,
       .doc = "Factor on all coordinates of the file: 1e-3 for millimetres in a case in metres."},
      {.name = "normal_radius",
       .type = KeyType::number,
       .unit = "length",
       .range = nonnegative,
       .doc = "Normals are means over the part of the surface that is so near, with a weight that falls to zero at "
              "this radius; 0: those of the facets, which jump at edges. Absent: a quarter of the largest distance "
              "between nodes of the contacts with it."},
      obstacle_side_key("Where bodies are: \"outside\" of what the surface encloses, or \"inside\"; then it must be "
                        "closed.")};
}

void tell_of(const RigidSurface& surface, const std::string& file) {
  const char* const noun = surface.in_space() ? "triangle" : "segment";
  if (surface.was_turned_round())
    log::warning(fmt::format("{}: the surface was inside out, its normals pointing inwards; all {}s were turned round",
                             file, noun));
  if (surface.flat_count() > 0)
    log::info(fmt::format("{}: {} {}s without {} touch nothing but by their neighbours", file, surface.flat_count(),
                          noun, surface.in_space() ? "an area" : "a length"));
  if (surface.is_closed()) return;
  const Three& place = surface.border_place();
  log::info(
      fmt::format("{}: the surface is not closed: {} {} to one {} only, one of them at ({:.4g}, {:.4g}, {:.4g}); "
                  "what is behind it counts as inside of the obstacle",
                  file, surface.border_count(), surface.in_space() ? "edges belong" : "corners belong", noun, place[0],
                  place[1], place[2]));
}

}  // namespace

ObstacleRegistration surface_obstacle() {
  const auto make = [](const Parameters& parameters) {
    const std::string& file = parameters.text("file");
    const double scale = parameters.number("scale"), side = obstacle_side(parameters);
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    RigidSurface surface(extension == ".stl" ? read_stl(file, scale) : read_polygons(file, scale), file);
    if (side < 0.0 && !surface.is_closed()) {
      const Three& place = surface.border_place();
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("{}: bodies are to be inside of this surface, but it is not closed: {} of its {} belong to "
                      "one {} only, the first at ({:.6g}, {:.6g}, {:.6g}); close it, or take side = \"outside\"",
                      file, surface.border_count(), surface.in_space() ? "edges" : "corners",
                      surface.in_space() ? "triangle" : "segment", place[0], place[1], place[2]));
    }
    tell_of(surface, file);
    std::optional<double> radius;
    if (parameters.has("normal_radius")) radius = parameters.number("normal_radius");
    Checksum sum;
    for (const Three& corner : surface.corners()) sum.add(corner.data(), 3);
    return std::make_unique<Surface>(std::move(surface), side, radius, sum.text());
  };
  return {"surface", make, surface_keys()};
}

}  // namespace ricochet
