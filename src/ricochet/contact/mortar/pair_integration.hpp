#pragma once

#include <map>

#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/mortar/surface_segments.hpp"

/// @file Integrals over the segments of a contact between bodies.
namespace ricochet {

/// Directions n_i of the multipliers, by their anchors: nodes, or facets.
using AnchorDirections = std::map<Index, Eigen::Vector3d>;

/// Integrals ∫ψ_i, ∫ψ_i φˢ_j, ∫ψ_i φᵐ_k and ∫ψ_i g of one multiplier.
struct MultiplierSums {
  double weight = 0.0, whole = 0.0;  ///< the second over the facets as a whole
  double gap = 0.0;
  std::map<Index, double> own, opposite;
};

/// Adds all contributions of a facet of the own surface. `direct`: its segments along its own normal, which multipliers
/// with that direction share.
class PairIntegration {
 public:
  PairIntegration(const Body& body, const FacetMap& map, const FacetSurface& own, const SegmentFinder& finder,
                  const MultiplierSpace& space, const AnchorDirections& directions)
      : map_(map), own_(own), finder_(finder), space_(space), directions_(directions), body_(body), whole_(body) {}

  void add_facet(int facet, const Eigen::Vector3d& normal, const FacetSegments& direct);
  [[nodiscard]] const std::map<Index, MultiplierSums>& sums() const { return sums_; }
  /// Number of omitted segments.
  [[nodiscard]] Index lost() const { return lost_; }

 private:
  void add_segments(int facet, const FacetSegments& segments, const std::vector<char>& included);

  const FacetMap& map_;
  const FacetSurface& own_;
  const SegmentFinder& finder_;
  const MultiplierSpace& space_;
  const AnchorDirections& directions_;
  const Body& body_;
  FacetIntegration whole_;
  FacetQuadrature quadrature_;
  FacetMultipliers functions_;
  FacetPoints points_;
  std::map<Index, MultiplierSums> sums_;
  Index lost_ = 0;
};

/// Pressure on the opposite side as a mean of that on the own one: entries (opposite vertex, own vertex, weight),
///   p_a = Σ_v (∫ ψˢ_v ψᵐ_a∘Π / ∫ ψᵐ_a∘Π) p_v   with the hat functions ψ of the vertices, over the covered part.
/// A uniform pressure is thus the same on both sides, up to the last covered node.
class PressureTransfer {
 public:
  PressureTransfer(const Body& body, const FacetMap& map) : body_(body), map_(map) {}
  void add_facet(Index facet, const FacetSegments& direct);
  [[nodiscard]] std::map<Index, std::vector<std::pair<Index, double>>> weights() const;

 private:
  const Body& body_;
  const FacetMap& map_;
  FacetPoints points_;
  Matrix hats_;
  std::map<Index, double> areas_;                       ///< of opposite vertices
  std::map<std::pair<Index, Index>, double> products_;  ///< (opposite vertex, own vertex)
};

/// Computes the measures on the own facet of the points of all segments, in their order,
/// with its shape functions there.
void gather_points(const FacetMap& map, Index facet, const FacetSegments& segments, FacetPoints& points);

}  // namespace ricochet
