#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "ricochet/mesh/search/box_tree.hpp"
#include "ricochet/rigid/surface/facet_weight.hpp"
#include "ricochet/rigid/surface/surface_file.hpp"

/// @file Surface of a rigid body: triangles or, in the plane, segments.
namespace ricochet {

/// A surface with exact distances. The sign is determined by the angle-weighted mean normal at the nearest edge or
/// corner (J. A. Bærentzen, H. Aanæs, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243–253). Everything has three
/// coordinates; in the plane the third is 0.
class RigidSurface {
 public:
  using Vector3 = Eigen::Vector3d;
  /// `name`: name of the file, for messages. Facets without area are kept, without a normal. Throws
  /// Error(invalid_input) that names the facet and its position if an edge has more than two facets, if a facet occurs
  /// twice, or if neighbours have opposite orientations. A closed surface that is inside out as a whole is reversed.
  RigidSurface(const SurfaceFacets& facets, const std::string& name);

  struct Foot {
    Vector3 position;  ///< the nearest point
    Vector3 normal;    ///< unit normal of the facet, edge or corner that contains it
    bool on_facet;     ///< in the interior of a facet: the gap is a linear function nearby
    bool on_border;    ///< on an edge that has one facet only
  };
  [[nodiscard]] Foot nearest(const Vector3& point) const;
  /// Mean height of a point above the planes of the facets, f = Σ w_k h_k / Σ w_k with w_k = ∫ (ρ² − |y − x|²) over the
  /// part of facet k within distance ρ, and its derivative. It is continuous for any facets, and equals the height
  /// above a plane if all nearby facets lie in one. Zero weight: no facet is within ρ.
  struct Height {
    double value = 0.0, weight = 0.0;
    Vector3 gradient = Vector3::Zero();
  };
  [[nodiscard]] Height mean_height(const Vector3& point, double radius) const;

  [[nodiscard]] bool is_closed() const { return border_count_ == 0; }
  /// Number of edges with one facet, and the midpoint of one of them.
  [[nodiscard]] long border_count() const { return border_count_; }
  [[nodiscard]] const Vector3& border_position() const { return border_position_; }
  [[nodiscard]] bool was_reversed() const { return was_reversed_; }
  /// Number of border corners that were merged with another one closer than a millionth of the surface's size.
  [[nodiscard]] long joined_count() const { return joined_count_; }
  /// Mean width of the facets across the edges, for a smoothly curved surface that bends by at most 30 degrees at every
  /// edge. Infinite if it has sharper edges or is flat.
  [[nodiscard]] double width_of_smooth() const;
  /// Number of facets without area.
  [[nodiscard]] long flat_count() const { return flat_count_; }
  [[nodiscard]] const std::vector<Vector3>& corners() const { return corners_; }
  [[nodiscard]] const std::vector<std::array<int, 3>>& facets() const { return facets_; }
  [[nodiscard]] bool in_space() const { return in_space_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }
  /// Sides, ascending, of the block with the second moments of the region that a closed surface encloses; the first is
  /// 0 in the plane. Unlike the sides of the bounding box they do not depend on the axes.
  [[nodiscard]] Vector3 block_sides() const;
  [[nodiscard]] BoxTree::Box box() const { return tree_.nodes().front().box; }
  /// Volume, or area in the plane, of the region that a closed surface encloses.
  [[nodiscard]] double volume() const;
  /// Volume, centre, and ∫ r rᵀ about the centre.
  struct Moments {
    double volume = 0.0;
    Vector3 centre = Vector3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  };
  [[nodiscard]] Moments moments() const;

 private:
  struct Edge {
    Vector3 normal = Vector3::Zero();
    bool is_border = false;
  };
  /// Side of a facet between two corners; `number`: from its corner of this number to the next.
  struct Side {
    int low, high, facet, number;
    bool forward;
  };
  void join_corners(const SurfaceFacets& facets);
  void find_normals(const std::string& name);
  [[nodiscard]] std::vector<Side> sorted_sides() const;
  void find_edges(const std::string& name);
  void check_edge(std::span<const Side> sides, const std::string& name) const;
  [[nodiscard]] bool join_borders();
  void measure_bend(std::span<const Side> sides);
  void find_corner_normals();
  void reverse_orientation();
  [[nodiscard]] Vector3 middle_of(const Side& side) const;
  [[nodiscard]] std::string text_of(int facet) const;
  [[nodiscard]] std::string position_text(const Vector3& position) const;
  [[nodiscard]] int corner_count() const { return in_space_ ? 3 : 2; }
  [[nodiscard]] const Vector3& corner(std::size_t facet, int k) const {
    return corners_[std::size_t(facets_[facet][std::size_t(k)])];
  }
  [[nodiscard]] FacetWeight weight_near(std::size_t facet, const Vector3& at, double radius) const;

  bool in_space_;
  std::vector<Vector3> corners_;            ///< each once
  std::vector<std::array<int, 3>> facets_;  ///< in the plane the last two corners are equal
  std::vector<Vector3> normals_;            ///< of facets; zero: without area
  std::vector<Edge> edges_;
  std::vector<std::array<int, 3>> edge_of_;  ///< of each facet: between corners 0 and 1, 1 and 2, 2 and 0
  std::vector<Edge> corner_normals_;
  long border_count_ = 0, flat_count_ = 0, joined_count_ = 0;
  double bent_width_ = 0.0, bent_count_ = 0.0, least_cosine_ = 1.0;
  Vector3 border_position_ = Vector3::Zero();
  bool was_reversed_ = false;
  BoxTree tree_;
};

}  // namespace ricochet
