#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/fem/cell_integration.hpp"

/// @file Integration over boundary facets, one facet at a time, on their curved geometry.
namespace ricochet {

/// Facet at the quadrature points of its block.
struct FacetQuadrature {
  Index facet = 0;  ///< numbered through all blocks
  CellShape shape = CellShape::interval;
  const Index* nodes = nullptr;  ///< of the displacement space, vertices first
  Points positions;              ///< d × points, on the curved facet
  Vector measure;                ///< per point: quadrature weight × area per reference area; sum: the area (of rings)
  const Matrix* displacement = nullptr;  ///< φ, nodes × points
  const Matrix* hats = nullptr;          ///< (multi)linear hat functions of the vertices, vertices × points
  bool whole = true;                     ///< whether the points cover the whole facet, not a part of it

  [[nodiscard]] Index node_count() const { return displacement->rows(); }
  [[nodiscard]] Index vertex_count() const { return hats->rows(); }
};

/// Integrates over the facets of a body. The rule is exact for products of two shape functions of the displacement on
/// straight facets; on curved facets of 3D bodies, where the area density is a square root, the same rule is used
/// everywhere, so that identities between integrals (partition of unity, biorthogonality) hold to rounding there, too.
class FacetIntegration {
 public:
  explicit FacetIntegration(const Body& body) : body_(&body) {
    const bool axisymmetric = is_axisymmetric(body);
    for (const CellBlock& block : body.mesh->facets) {
      const int degree = body.mesh->degree;
      rules_.emplace_back(block.shape, degree, body.space->degree,
                          product_quadrature_degree(block.shape, degree, body.space->degree, axisymmetric) + 1,
                          axisymmetric);
      hats_.push_back(ReferenceElement::get(block.shape, 1).tabulate(rules_.back().rule.points).values);
    }
  }

  /// Evaluates a facet numbered through all blocks. Pointers in `result` are valid for the lifetime of this object.
  void evaluate(Index facet, FacetQuadrature& result) const {
    const IndexInBlocks location = locate_facet(*body_->space, facet);
    const std::size_t b = location.block;
    const Index local = location.local;
    const CellBlock& geometry = body_->mesh->facets[b];
    const BlockIntegration& integration = rules_[b];
    result.facet = facet;
    result.shape = geometry.shape;
    result.nodes = body_->space->facets[b].cell(local);
    result.displacement = &integration.displacement.values;
    result.hats = &hats_[b];
    result.positions.setZero(body_->mesh->dimension, integration.rule.weights.size());
    for (int k = 0; k < geometry.nodes_per_cell; ++k) {
      result.positions += body_->mesh->nodes.col(geometry.cell(local)[k]) * integration.geometry.values.row(k);
    }
    result.measure.resize(integration.rule.weights.size());
    for (Index q = 0; q < result.measure.size(); ++q) {
      const Matrix& gradients = integration.geometry.gradients[std::size_t(q)];
      const double density =
          body_->mesh->dimension == 2
              ? facet_measure<2>(jacobian<2, 1>(body_->mesh->nodes, geometry.cell(local), gradients))
              : facet_measure<3>(jacobian<3, 2>(body_->mesh->nodes, geometry.cell(local), gradients));
      result.measure[q] =
          integration.rule.weights[q] * density * integration.ring(body_->mesh->nodes, geometry.cell(local), q);
    }
  }

 private:
  const Body* body_;
  std::vector<BlockIntegration> rules_;
  std::vector<Matrix> hats_;
};

}  // namespace ricochet
