#pragma once

#include <vector>

#include "ricochet/contact/mortar/facet_surface.hpp"

/// @file Where two surfaces face each other: the pieces into which the facets of both cut one of them, with points to
/// integrate over each.
namespace ricochet {

/// The part of a facet of the own surface that one facet of the opposite surface faces.
struct SurfaceSegment {
  Index opposite = 0;     ///< facet, numbered through all blocks
  Points own_local;       ///< reference coordinates on the own facet, (d−1) × points
  Points opposite_local;  ///< on the opposite facet, of the points that face them
  Vector weights;         ///< areas in the plane perpendicular to the direction
};

struct FacetSegments {
  Points axes;  ///< d × (d−1), orthonormal with the direction
  std::vector<SurfaceSegment> segments;
  double covered = 0.0;  ///< part of the facet, seen along the direction, that faces the other surface
  Index lost = 0;        ///< segments left out, as a curved facet is seen edge-on there
  [[nodiscard]] bool is_whole() const { return covered > 1.0 - 1e-8; }
};

/// Of the height of what is behind two pieces: overlaps that are deeper are none.
constexpr double deepest_overlap = 0.5;

/// Cuts facets of one surface by those of another, seen along one direction.
///
/// Both are cut in the plane perpendicular to the direction: intervals in two dimensions, polygons of triangles in
/// three. A rule on every triangle of a polygon integrates there, so that what is piecewise polynomial on the two
/// meshes is integrated exactly: of degree `degree` of the facets' own coordinates, where those depend linearly on the
/// place. Own and opposite shape functions are taken at the same points: their sums agree to rounding with any rule.
class SegmentFinder {
 public:
  /// Keeps references. `own` and `opposite` may belong to one body.
  SegmentFinder(const FacetMap& map, const FacetSurface& own, const FacetSurface& opposite, int degree);

  /// Of each own facet, the opposite ones that it does not see, by their places in facets(), ascending: those near it,
  /// where both surfaces are one.
  void leave_out(std::vector<std::vector<int>> unseen) { unseen_ = std::move(unseen); }

  /// `facet`: place in own.facets(). `direction`: unit, out of the opposite surface. Pieces that are seen nearly
  /// edge-on, or do not face each other, count for nothing, and so do those that lie inside of each other by more than
  /// half of the height of the cells behind them: a line that passes through a thin body meets its far side there. Of
  /// several pieces behind each other the nearest counts. `any_depth`: no overlap is too deep.
  [[nodiscard]] FacetSegments find(int facet, const Eigen::Vector3d& direction, bool any_depth = false) const;

  /// A point of the own side, seen along a direction: the facet that it faces, and where. None: facet −1.
  /// What is off a facet by less, in its size, is on it.
  static constexpr double on_rim = 1e-7;
  struct Hit {
    Index facet = -1;
    Points local;      ///< (d−1) × 1
    double gap = 0.0;  ///< along the direction
  };
  /// `reach`: how far it may be inside of the opposite surface. `beyond`: how far off the surface's rim, in sizes of a
  /// facet, which is continued there. `unseen`: opposite facets that it does not see, by place, ascending.
  [[nodiscard]] Hit find_point(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double reach,
                               double beyond = on_rim, const std::vector<int>& unseen = {}) const;
  /// How thick the body behind an own facet is: from its centre against its normal to the nearest opposite piece.
  /// Infinite: there is none.
  [[nodiscard]] double thickness_behind(int facet) const;

 private:
  struct View;
  struct Cut;
  template <class Visit>
  void visit_pieces_at(const View& view, const Eigen::Vector2d& at, double beyond, const Visit& visit) const;
  void cut_piece(const View& view, int piece, bool any_depth, std::vector<Cut>& cuts) const;
  void add_points(const View& view, const std::vector<Cut>& cuts, std::vector<SurfaceSegment>& segments) const;
  [[nodiscard]] bool find_coordinates(Index facet, const Points& axes, SurfaceSegment& segment) const;

  const FacetMap& map_;
  const FacetSurface &own_, &opposite_;
  QuadratureRule interval_, triangle_;
  std::vector<std::vector<int>> unseen_;  ///< empty: every facet sees all
};

}  // namespace ricochet
