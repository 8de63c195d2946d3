#include <cmath>
#include <limits>
#include <map>

#include "ricochet/contact/construction/boundary_patch.hpp"

namespace ricochet {

namespace {

/// Mean position of a multiplier's nodes; that of its anchor if this is a node.
Vector anchor_position(const DisplacementSpace& space, const Multiplier& multiplier) {
  if (multiplier.node >= 0) return space.nodes.col(multiplier.node);
  Vector position = Vector::Zero(space.dimension);
  for (const auto& [node, weight] : multiplier.trace) position += weight * space.nodes.col(node);
  return position;
}

/// Computes (1/D_i) ∫ψ_i g₀ over the curved facets, by anchor.
std::map<Index, double> mean_gaps(const BoundaryPatch& patch) {
  std::map<Index, double> gaps, weights;
  const FacetIntegration integration(*patch.facets.body);
  FacetQuadrature quadrature;
  FacetMultipliers functions;
  Vector gap;
  for (const ContactPatch::Part& part : patch.facets.parts) {
    for (const Index facet : part.facets) {
      integration.evaluate(facet, quadrature);
      patch.space->evaluate(quadrature, functions);
      gap.resize(quadrature.measure.size());
      for (Index q = 0; q < gap.size(); ++q) gap[q] = patch.obstacle->gap(quadrature.positions.col(q));
      const Matrix weighted = functions.values * quadrature.measure.asDiagonal();
      for (std::size_t k = 0; k < functions.anchors.size(); ++k) {
        gaps[functions.anchors[k]] += weighted.row(Index(k)).dot(gap);
        weights[functions.anchors[k]] += weighted.row(Index(k)).sum();
      }
    }
  }
  for (auto& [anchor, gap_integral] : gaps) gap_integral /= weights.at(anchor);
  return gaps;
}

}  // namespace

/// If the displacement space contains the geometry, the trace of the nodes' gaps is
/// exactly the mean gap against planes.
void compute_obstacle_conditions(const Body& body, BoundaryPatch& patch) {
  // Displacements result from solutions for the whole body, so that their rounding is relative to
  // its size, wherever a node is.
  const double body_size = extent(body.space->nodes);
  const double body_rounding = 8.0 * std::numeric_limits<double>::epsilon() * body_size;
  const bool by_quadrature = patch.space->has_functions() && body.mesh->degree > body.space->degree;
  const std::map<Index, double> means = by_quadrature ? mean_gaps(patch) : std::map<Index, double>{};
  for (const Multiplier& multiplier : patch.retained) {
    PointConditions conditions{patch.obstacle->normal(anchor_position(*body.space, multiplier)), {}, 0.0, 0.0};
    for (const auto& [node, weight] : multiplier.trace) {
      const Vector position = body.space->nodes.col(node);
      conditions.gap += weight * patch.obstacle->gap(position);
      conditions.gap_rounding += std::abs(weight) * (patch.obstacle->gap_rounding(position) + body_rounding);
    }
    if (by_quadrature) conditions.gap = means.at(multiplier.node >= 0 ? multiplier.node : multiplier.facet);
    patch.conditions.push_back(std::move(conditions));
  }
}

}  // namespace ricochet
