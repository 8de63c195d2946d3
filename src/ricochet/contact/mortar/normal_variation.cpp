#include "ricochet/contact/mortar/normal_variation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "ricochet/base/angles.hpp"
#include "ricochet/contact/mortar/facet_surface.hpp"
#include "ricochet/mesh/disjoint_sets.hpp"

namespace ricochet {

namespace {

using Vector3 = FacetSurface::Vector3;

/// Facets whose normals differ by less than `level` are coplanar; neighbours at more than `edge` meet at an edge.
constexpr double level = 1e-6, edge = 0.25 * std::numbers::pi;

/// Angle, in angles between two facets, up to which a normal counts as included beyond the last of them.
constexpr double past_end = 0.75;

BoxTree::Box box_around(const Vector3& centre, double reach) {
  return {centre - Vector3::Constant(reach), centre + Vector3::Constant(reach)};
}

/// Mean or sum over facets that can touch the other surface: their angles per length, with edges and without.
struct Bend {
  double curvature = 0.0, smooth = 0.0, size = 0.0;
  double bulge = 0.0;  ///< the curvature, negative if the surface is concave
  double weight = 0.0;
  void add(const Bend& other, double of_weight) {
    curvature += of_weight * other.curvature;
    smooth += of_weight * other.smooth;
    size += of_weight * other.size;
    bulge += of_weight * other.bulge;
    weight += of_weight;
  }
  [[nodiscard]] Bend mean() const {
    return {curvature / weight, smooth / weight, size / weight, bulge / weight, weight};
  }
};

/// One surface, searchable by its normals.
class SurfaceNormals {
 public:
  SurfaceNormals(const Body& body, const std::vector<Index>& facets) : surface_(body, facets) {
    for (const FacetSurface::Facet& facet : surface_.facets()) normals_.push_back(facet.area_vector.normalized());
    find_joints(*body.mesh);
    find_planes();
  }

  /// Connected coplanar facets, or one facet.
  struct Plane {
    Vector3 normal = Vector3::Zero();
    Bend bend;  ///< a mean; its weight is the area
  };
  [[nodiscard]] const std::vector<Plane>& planes() const { return planes_; }

  struct Sight {
    Bend bend;  ///< a mean; its weight is zero if no facet has this normal
    bool is_level = false;
  };
  /// Finds facets with this normal; if there are none, those between whose normals it lies.
  [[nodiscard]] Sight find_sight(const Vector3& normal) const {
    const auto may_have = [&](const BoxTree::Box& box) { return box.contains(normal); };
    Sight result;
    plane_tree_.visit(may_have, [&](int number) {
      const Plane& plane = planes_[std::size_t(number)];
      if (angle_between(plane.normal, normal) > level) return;
      result.is_level = true;
      result.bend.add(plane.bend, plane.bend.weight);
    });
    if (!result.is_level && !joints_.empty()) result.bend = find_bend(normal, may_have);
    if (result.bend.weight > 0.0) result.bend = result.bend.mean();
    return result;
  }

 private:
  /// Two facets that share a node and are not coplanar.
  struct Joint {
    std::size_t one = 0, other = 0;
    double angle = 0.0;
    Bend bend;
  };

  /// Finds joints whose normals include a given one; if there are none, those adjacent to it: a surface that ends at a
  /// plane of symmetry touches its counterpart across that plane with half of a facet.
  template <class MayHave>
  [[nodiscard]] Bend find_bend(const Vector3& normal, const MayHave& may_have) const {
    Bend within, beside;
    joint_tree_.visit(may_have, [&](int number) {
      const Joint& joint = joints_[std::size_t(number)];
      const double one = angle_between(normals_[joint.one], normal),
                   other = angle_between(normals_[joint.other], normal);
      if (std::max(one, other) <= joint.angle + level) {
        within.add(joint.bend, 1.0);
      } else if (std::min(one, other) <= past_end * joint.angle && is_last(one < other ? joint.one : joint.other)) {
        beside.add(joint.bend, 1.0);
      }
    });
    return within.weight > 0.0 ? within : beside;
  }

  /// Whether the facet is the end of a line in 2D: it has one neighbour.
  [[nodiscard]] bool is_last(std::size_t facet) const { return facet_bends_[facet].weight == 1.0; }

  void find_joints(const Mesh& mesh) {
    const std::vector<FacetSurface::Facet>& facets = surface_.facets();
    std::map<Index, std::vector<std::size_t>> around;
    for (std::size_t k = 0; k < facets.size(); ++k) {
      const IndexInBlocks location = locate_in_blocks(mesh.facets, facets[k].number);
      const CellBlock& block = mesh.facets[location.block];
      for (int v = 0; v < vertex_count(block.shape); ++v) around[block.cell(location.local)[v]].push_back(k);
    }
    sets_ = DisjointSets(Index(facets.size()));
    facet_bends_.resize(facets.size());
    for (const auto& [node, here] : around) {
      for (std::size_t i = 0; i < here.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) join(here[j], here[i]);
      }
    }
    std::vector<BoxTree::Box> boxes;
    for (const Joint& joint : joints_) {
      const Vector3 &a = normals_[joint.one], &b = normals_[joint.other];
      boxes.push_back(box_around(0.5 * (a + b), (0.5 + past_end) * angle_between(a, b) + 2.0 * level));
    }
    if (!boxes.empty()) joint_tree_ = BoxTree(boxes);
  }

  /// Facets that share an edge in 3D are joined at both of its ends, in the same way.
  void join(std::size_t one, std::size_t other) {
    const FacetSurface::Facet &a = surface_.facets()[one], &b = surface_.facets()[other];
    const double angle = angle_between(normals_[one], normals_[other]), distance = (a.centre - b.centre).norm();
    const bool bends = angle > level && distance > 0.0;
    Bend bend{bends ? angle / distance : 0.0, 0.0, 0.5 * (a.size + b.size)};
    bend.smooth = angle > edge ? 0.0 : bend.curvature;
    bend.bulge = (b.centre - a.centre).dot(normals_[one]) > 0.0 ? -bend.curvature : bend.curvature;
    for (const std::size_t facet : {one, other}) facet_bends_[facet].add(bend, 1.0);
    if (bends) joints_.push_back({one, other, angle, bend});
    if (!bends) sets_.join(Index(one), Index(other));
  }

  void find_planes() {
    std::map<Index, std::size_t> number_of;
    for (std::size_t k = 0; k < normals_.size(); ++k) {
      const FacetSurface::Facet& facet = surface_.facets()[k];
      const auto [at, added] = number_of.try_emplace(sets_.root(Index(k)), planes_.size());
      if (added) planes_.emplace_back();
      Plane& plane = planes_[at->second];
      plane.normal += facet.area_vector;
      Bend bend = facet_bends_[k].weight > 0.0 ? facet_bends_[k].mean() : Bend{};
      bend.size = facet.size;
      plane.bend.add(bend, facet.area);
    }
    std::vector<BoxTree::Box> boxes;
    for (Plane& plane : planes_) {
      plane.normal.normalize();
      plane.bend = plane.bend.mean();
      boxes.push_back(box_around(plane.normal, 2.0 * level));
    }
    if (!boxes.empty()) plane_tree_ = BoxTree(boxes);
  }

  FacetSurface surface_;
  std::vector<Vector3> normals_;
  std::vector<Bend> facet_bends_;  ///< per facet, towards its neighbours: sums
  std::vector<Joint> joints_;
  DisjointSets sets_{0};
  std::vector<Plane> planes_;
  BoxTree joint_tree_, plane_tree_;
};

/// Sums over locations; `first`: the surface over whose facets the sum runs.
struct VariationSums {
  double first = 0.0, second = 0.0, first_of_bends = 0.0, second_of_bends = 0.0, area = 0.0, area_of_bends = 0.0;
};

double variation_of(const Bend& carrier, const Bend& other, bool is_straight, double Bend::*curvature) {
  const double window = is_straight ? std::max(carrier.size, other.size) : carrier.size;
  return carrier.size * (carrier.*curvature) + 2.0 * window * (other.*curvature);
}

/// Whether one surface is concave and the other one does not fit in: the facets would penetrate each other.
bool are_parted(const Bend& one, const Bend& other) {
  constexpr double fitting = 0.1;
  return one.bulge + other.bulge < -fitting * (one.curvature + other.curvature);
}

VariationSums sums_over(const SurfaceNormals& first, const SurfaceNormals& second, bool is_straight) {
  VariationSums sums;
  for (const SurfaceNormals::Plane& plane : first.planes()) {
    const SurfaceNormals::Sight opposite = second.find_sight(-plane.normal);
    if (!(opposite.bend.weight > 0.0) || (!opposite.is_level && are_parted(plane.bend, opposite.bend))) continue;
    const double area = plane.bend.weight;
    sums.area += area;
    sums.first += area * variation_of(plane.bend, opposite.bend, is_straight, &Bend::curvature);
    sums.second += area * variation_of(opposite.bend, plane.bend, is_straight, &Bend::curvature);
    if (!(plane.bend.smooth + opposite.bend.smooth > 0.0)) continue;
    sums.area_of_bends += area;
    sums.first_of_bends += area * variation_of(plane.bend, opposite.bend, is_straight, &Bend::smooth);
    sums.second_of_bends += area * variation_of(opposite.bend, plane.bend, is_straight, &Bend::smooth);
  }
  return sums;
}

}  // namespace

NormalVariation normal_variation(const Body& body, const std::vector<Index>& facets,
                                 const std::vector<Index>& opposite_facets) {
  const SurfaceNormals own(body, facets), opposite(body, opposite_facets);
  const bool is_straight = body.mesh->degree == 1;
  const VariationSums one = sums_over(own, opposite, is_straight), other = sums_over(opposite, own, is_straight);
  const double area = one.area + other.area, of_bends = one.area_of_bends + other.area_of_bends;
  NormalVariation result;
  result.touch = area > 0.0;
  if (area > 0.0) {
    result.own = (one.first + other.second) / area;
    result.opposite = (one.second + other.first) / area;
  }
  if (of_bends > 0.0) {
    result.own_of_bends = (one.first_of_bends + other.second_of_bends) / of_bends;
    result.opposite_of_bends = (one.second_of_bends + other.first_of_bends) / of_bends;
  }
  return result;
}

}  // namespace ricochet
