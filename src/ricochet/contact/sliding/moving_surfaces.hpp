#pragma once

#include <map>
#include <vector>

#include "ricochet/contact/mortar/facet_surface.hpp"
#include "ricochet/contact/mortar/surface_segments.hpp"

/// @file The two surfaces of a pair wherever their nodes have moved to.
namespace ricochet {

class MovingSurfaces {
 public:
  MovingSurfaces(const Body& body, const std::vector<Index>& facets, const std::vector<Index>& opposite_facets);
  MovingSurfaces(const MovingSurfaces&) = delete;  // finders refer to the surfaces
  MovingSurfaces& operator=(const MovingSurfaces&) = delete;

  /// To X + U. Does nothing where they are there already.
  void move(const Vector& displacement);

  /// Where both surfaces are one: facets do not see those within two rings around them, and those behind the body.
  void see_itself();

  [[nodiscard]] const FacetMap& map() const { return map_; }
  [[nodiscard]] const FacetSurface& own() const { return own_; }
  [[nodiscard]] const FacetSurface& opposite() const { return opposite_; }
  [[nodiscard]] const SegmentFinder& finder() const { return finder_; }
  /// Of both, ascending.
  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
  [[nodiscard]] Eigen::Vector3d position(Index node) const;
  /// The least height of what is behind the facets around a node of the own surface.
  [[nodiscard]] double depth_at(Index node) const;
  /// Facets of the opposite surface that a node of the own one does not see, by place; none where there are two.
  [[nodiscard]] const std::vector<int>& unseen_from(Index node) const;
  /// Multiplies values, one per column, by areas of the reference configuration over those where the surface is.
  void scale_to_reference(Index facet, const Points& local, Matrix& values) const;

 private:
  const Body& reference_body_;
  Mesh mesh_;  ///< of the displacement's nodes, where they are
  Body body_;
  FacetMap reference_, map_;
  FacetSurface own_, opposite_;
  SegmentFinder finder_;
  std::vector<Index> nodes_;
  std::map<Index, std::vector<int>> facets_at_;    ///< a node; empty where there are two surfaces
  std::map<Index, std::vector<int>> unseen_from_;  ///< a node; empty where there are two surfaces
  Vector moved_by_;
};

}  // namespace ricochet
