#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "ricochet/mesh/search/box_tree.hpp"
#include "ricochet/rigid/surface/facet_weight.hpp"
#include "ricochet/rigid/surface/surface_file.hpp"

/// @file The surface of a rigid body, of triangles or, in the plane, of segments.
namespace ricochet {

/// Distances to it are exact. Inside and outside are told by the angle-weighted mean of the normals at the edge or
/// corner that is nearest (J. A. Bærentzen, H. Aanæs, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243–253).
/// Everything has three coordinates; in the plane the third is 0.
class RigidSurface {
 public:
  using Three = Eigen::Vector3d;
  /// `name`: of the file, for messages. Facets without area are kept, without a normal. Throws Error(invalid_input)
  /// that names the facet and its place where an edge has more than two facets, a facet is there twice, or neighbours
  /// are turned against each other. One that is closed and turned inside out as a whole is turned round.
  RigidSurface(const SurfaceFacets& facets, const std::string& name);

  struct Foot {
    Three position;  ///< the nearest point
    Three normal;    ///< of the facet, edge or corner that it is on, of length 1
    bool on_facet;   ///< inside of a facet: the gap is a linear function around
    bool on_border;  ///< on an edge that has one facet only
  };
  [[nodiscard]] Foot nearest(const Three& point) const;
  /// The mean height of a point above the planes of the facets, f = Σ w_k h_k / Σ w_k, w_k = ∫ (ρ² − |y − x|²) over the
  /// part of facet k that is nearer than ρ, and its derivative: continuous, whatever the facets are, and the height
  /// above a plane where all that is near is one. No weight: nothing is so near.
  struct Height {
    double value = 0.0, weight = 0.0;
    Three gradient = Three::Zero();
  };
  [[nodiscard]] Height mean_height(const Three& point, double radius) const;

  [[nodiscard]] bool is_closed() const { return border_count_ == 0; }
  /// Edges with one facet, and the middle of one of them.
  [[nodiscard]] long border_count() const { return border_count_; }
  [[nodiscard]] const Three& border_place() const { return border_place_; }
  [[nodiscard]] bool was_turned_round() const { return turned_round_; }
  /// Corners of borders that lay nearer to another than a millionth of the surface, and are one with it.
  [[nodiscard]] long joined_count() const { return joined_count_; }
  /// Of a surface that bends smoothly, by no more than 30 degrees at any edge: the mean width of its facets across the
  /// edges. Infinite: it has sharper ones, or is flat.
  [[nodiscard]] double width_of_smooth() const;
  /// Of those without area.
  [[nodiscard]] long flat_count() const { return flat_count_; }
  [[nodiscard]] const std::vector<Three>& corners() const { return corners_; }
  [[nodiscard]] const std::vector<std::array<int, 3>>& facets() const { return facets_; }
  [[nodiscard]] bool in_space() const { return in_space_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }
  /// Sides of the block with the second moments of what a closed surface encloses, ascending; the first is 0 in the
  /// plane. They do not depend on the axes, as those of the box around it do.
  [[nodiscard]] Three block_sides() const;
  [[nodiscard]] BoxTree::Box box() const { return tree_.nodes().front().box; }
  /// Of what it encloses, where it is closed: volume, or area in the plane.
  [[nodiscard]] double volume() const;
  /// The same with the centre, and ∫ r rᵀ about it.
  struct Moments {
    double volume = 0.0;
    Three centre = Three::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  };
  [[nodiscard]] Moments moments() const;

 private:
  struct Edge {
    Three normal = Three::Zero();
    bool is_border = false;
  };
  /// Of a facet, between two corners; `number`: from its corner of this number to the next.
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
  void look_at_bend(std::span<const Side> sides);
  void find_corner_normals();
  void turn_round();
  [[nodiscard]] Three middle_of(const Side& side) const;
  [[nodiscard]] std::string text_of(int facet) const;
  [[nodiscard]] std::string place_text(const Three& place) const;
  [[nodiscard]] int corner_count() const { return in_space_ ? 3 : 2; }
  [[nodiscard]] const Three& corner(std::size_t facet, int k) const {
    return corners_[static_cast<std::size_t>(facets_[facet][static_cast<std::size_t>(k)])];
  }
  [[nodiscard]] FacetWeight weight_near(std::size_t facet, const Three& at, double radius) const;

  bool in_space_;
  std::vector<Three> corners_;              ///< each once
  std::vector<std::array<int, 3>> facets_;  ///< in the plane the last two are the same
  std::vector<Three> normals_;              ///< of facets; zero: without area
  std::vector<Edge> edges_;
  std::vector<std::array<int, 3>> edge_of_;  ///< of each facet: between corners 0 and 1, 1 and 2, 2 and 0
  std::vector<Edge> corner_normals_;
  long border_count_ = 0, flat_count_ = 0, joined_count_ = 0;
  double bent_width_ = 0.0, bent_count_ = 0.0, least_cosine_ = 1.0;
  Three border_place_ = Three::Zero();
  bool turned_round_ = false;
  BoxTree tree_;
};

}  // namespace ricochet
