#pragma once

#include <vector>

#include "ricochet/contact/mortar/facet_surface.hpp"

/// @file Segments on which two surfaces face each other: the intersections of the facets of
/// both, with quadrature points.
namespace ricochet {

/// Part of a facet of the own surface that faces one facet of the opposite surface.
struct SurfaceSegment {
  Index opposite = 0;     ///< facet, numbered through all blocks
  Points own_local;       ///< reference coordinates on the own facet, (d−1) × points
  Points opposite_local;  ///< their projections on the opposite facet
  Vector weights;         ///< areas in the plane perpendicular to the direction
};

struct FacetSegments {
  Points axes;  ///< d × (d−1), orthonormal with the direction
  std::vector<SurfaceSegment> segments;
  double covered = 0.0;  ///< fraction of the facet, as projected along the direction, that faces the other surface
  Index lost = 0;        ///< number of segments omitted because a curved facet is seen edge-on there
  [[nodiscard]] bool is_whole() const { return covered > 1.0 - 1e-8; }
};

/// Deepest admissible overlap, relative to the depth of the body behind the facets of two pieces (Facet::body_depth).
constexpr double deepest_overlap = 0.5;

/// Intersects facets of one surface with those of another, projected along one direction.
///
/// Both are intersected in the plane perpendicular to the direction: intervals in 2D, polygons of triangles in 3D. A
/// rule on every triangle of a polygon integrates piecewise polynomials on the two meshes exactly: up to degree
/// `degree` in the facets' own coordinates, if those depend linearly on the position. Own and opposite shape functions
/// are evaluated at the same points: their sums agree to rounding for any rule.
class SegmentFinder {
 public:
  /// Keeps references. `own` and `opposite` may belong to one body.
  SegmentFinder(const FacetMap& map, const FacetSurface& own, const FacetSurface& opposite, int degree);

  /// Sets for each own facet the opposite facets to be ignored, by their indices in facets(), ascending: those in its
  /// neighbourhood if both surfaces are one.
  void set_ignored_facets(std::vector<std::vector<int>> facets) { ignored_facets_ = std::move(facets); }

  /// Finds the segments of own facet number `facet` in own.facets(). `direction`: unit, out of the opposite surface.
  /// Pieces that are seen nearly edge-on, or do not face each other, are ignored, and so are those that overlap by more
  /// than half of the depth of the body behind them: a line through a thin body meets its far side there. Of several
  /// pieces behind each other the nearest counts. `any_depth`: admits any overlap.
  [[nodiscard]] FacetSegments find(int facet, const Eigen::Vector3d& direction, bool any_depth = false) const;

  /// Projection of a point of the own side along a direction: the facet that it hits, and where. Facet −1 if none.
  /// A distance outside of a facet below on_rim, relative to its size, counts as on it.
  static constexpr double on_rim = 1e-7;
  struct Hit {
    Index facet = -1;
    Points local;      ///< (d−1) × 1
    double gap = 0.0;  ///< along the direction
  };
  /// Projects a point. `reach`: admissible depth inside the opposite surface. `beyond`: admissible distance outside
  /// the surface's boundary, in sizes of a facet, over which it is extrapolated. `ignored_facets`: opposite facets to
  /// be ignored, by index, ascending.
  [[nodiscard]] Hit find_point(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double reach,
                               double beyond = on_rim, const std::vector<int>& ignored_facets = {}) const;
  /// Thickness of the body behind an own facet: from its centre against its normal to the nearest opposite
  /// piece. Infinite if there is none.
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
  std::vector<std::vector<int>> ignored_facets_;  ///< empty if no facet is ignored
};

}  // namespace ricochet
