#pragma once

#include <map>
#include <vector>

#include "ricochet/contact/mortar/facet_surface.hpp"
#include "ricochet/contact/mortar/surface_segments.hpp"

/// @file The two surfaces of a pair at the current positions of their nodes.
namespace ricochet {

class MovingSurfaces {
 public:
  MovingSurfaces(const Body& body, const std::vector<Index>& facets, const std::vector<Index>& opposite_facets);
  MovingSurfaces(const MovingSurfaces&) = delete;  // finders refer to the surfaces
  MovingSurfaces& operator=(const MovingSurfaces&) = delete;

  /// Moves the surfaces to X + U. Does nothing if they are there already.
  void move(const Vector& displacement);

  /// Prepares a surface for contact with itself: facets ignore those within two rings around them, and half the initial
  /// thickness of the body becomes its depth behind them, so that its far side is not taken for a surface that was
  /// passed.
  void enable_self_contact();

  [[nodiscard]] const FacetMap& map() const { return map_; }
  /// Map of the facets at rest.
  [[nodiscard]] const FacetMap& reference_map() const { return reference_; }
  [[nodiscard]] const FacetSurface& own() const { return own_; }
  [[nodiscard]] const FacetSurface& opposite() const { return opposite_; }
  [[nodiscard]] const SegmentFinder& finder() const { return finder_; }
  /// Nodes of both surfaces, ascending.
  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
  /// Current position of one of these nodes.
  [[nodiscard]] Eigen::Vector3d position(Index node) const;
  /// Least depth of the body behind the facets around a node of the own surface; with two surfaces, a cell height.
  [[nodiscard]] double depth_at(Index node) const;
  /// Facets of the opposite surface that a node of the own one ignores, by index; none if there are two surfaces.
  [[nodiscard]] const std::vector<int>& ignored_facets_of(Index node) const;
  /// Multiplies values, one per column, by the ratio of reference to current areas.
  void scale_to_reference(Index facet, const Points& local, Matrix& values) const;

 private:
  const Body& reference_body_;
  Mesh mesh_;  ///< of the displacement's nodes; those in nodes() at their current positions
  Body body_;
  FacetMap reference_, map_;
  FacetSurface own_, opposite_;
  SegmentFinder finder_;
  std::vector<Index> nodes_;
  std::map<Index, std::vector<int>> facets_at_;          ///< per node; empty if there are two surfaces
  std::map<Index, std::vector<int>> ignored_facets_of_;  ///< per node; empty if there are two surfaces
  Vector moved_by_;
};

}  // namespace ricochet
