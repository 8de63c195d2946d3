#include <algorithm>
#include <map>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Biorthogonal multipliers, one per node. Facet by facet, with a basis φ̃ = T φ of the displacement's trace,
///   ψ = D_e M_e⁻¹ φ̃,   M_e = ∫_e φ̃ φ̃ᵀ,   D_e = diag ∫_e φ̃,   so that ∫_e ψ_i φ̃_j = δ_ij ∫_e φ̃_i,
/// with the area of the curved facet. Since Σφ̃ = 1, M_e 1 = D_e 1 and Σψ = 1: a uniform pressure is in the space.
/// D_i = ∫φ̃_i, and the trace c is the inverse change of basis: for φ̃ = φ the identity.
///
/// On triangular facets of degree 2 ∫φ_v = 0 at vertices, so the basis is changed (Popp, Wohlmuth, Gee and Wall, Dual
/// quadratic mortar finite element methods for 3D finite deformation contact, SIAM J. Sci. Comput. 34, 2012,
/// B421–B446):
///   φ̃_v = φ_v + α Σ_e φ_e over the edges e at v,   φ̃_e = (1 − 2α) φ_e,   α = 1/5,
/// on every edge of a triangular facet, including edges shared with facets of another shape. The coefficients of a
/// trace with nodal values g are then g̃_v = g_v and g̃_e = (g_e − α (g_v1 + g_v2))/(1 − 2α).
///
/// A facet of degree 2 with an end on the axis of an axisymmetric body has this change of basis, too: ∫φ_v 2πr = 0 at
/// that end.
///
/// Between bodies a facet may be covered partially. Functions that are biorthogonal on the covered part can
/// have negative integrals (on less than 2/3 of an interval, those of the whole one do), or come from a matrix
/// that is nearly singular. Such a facet therefore has Bernstein polynomials: they span the same space, are
/// positive and sum to 1 on any part.
class DualMultipliers final : public MultiplierSpace {
 public:
  explicit DualMultipliers(const ContactPatch& patch) : MultiplierSpace(patch), integration_(*patch.body) {
    const DisplacementSpace& space = *patch.body->space;
    if (space.degree == 1) return;
    for (const ContactPatch::Part& part : patch.parts) {
      for (const Index facet : part.facets) {
        const IndexInBlocks location = locate_facet(space, facet);
        const CellBlock& block = space.facets[location.block];
        const Index* nodes = block.cell(location.local);
        if (block.shape != CellShape::triangle && !ends_on_axis(nodes)) continue;
        const auto& vertices_of = node_vertices(block.shape, 2);
        for (std::size_t k = 0; k < vertices_of.size(); ++k) {
          if (vertices_of[k].size() != 2) continue;
          transformed_[nodes[k]] = {nodes[vertices_of[k][0]], nodes[vertices_of[k][1]]};
        }
      }
    }
  }

  [[nodiscard]] std::vector<Multiplier> multipliers() const override {
    std::map<Index, Multiplier> by_node;
    FacetQuadrature quadrature;
    for (const ContactPatch::Part& part : patch().parts) {
      for (const Index facet : part.facets) {
        integration_.evaluate(facet, quadrature);
        const Vector weights = basis_change(quadrature) * (*quadrature.displacement * quadrature.measure);
        for (Index k = 0; k < weights.size(); ++k) {
          const Index node = quadrature.nodes[k];
          const auto [entry, added] = by_node.try_emplace(node);
          if (added) entry->second = {part.pair, node, -1, 0.0, trace_of(node)};
          entry->second.weight += weights[k];
        }
      }
    }
    std::vector<Multiplier> result;
    for (const auto& [node, multiplier] : by_node) result.push_back(multiplier);
    return result;
  }

  /// Recovers the continuous field Σ λ_i φ̃_i at the nodes; if supports have removed a vertex,
  /// the mean of the remaining ones.
  [[nodiscard]] std::vector<Eigen::Triplet<double>> pressure_recovery(
      const std::vector<Multiplier>& retained) const override {
    std::map<Index, int> number;
    for (std::size_t i = 0; i < retained.size(); ++i) number[retained[i].node] = int(i);
    std::vector<Eigen::Triplet<double>> result;
    for (const Multiplier& multiplier : retained) {
      std::vector<std::pair<Index, double>> shares{{multiplier.node, 1.0}};
      const auto middle = transformed_.find(multiplier.node);
      if (middle != transformed_.end()) {
        shares.front().second = 1.0 - 2.0 * alpha;
        for (const Index vertex : middle->second) shares.emplace_back(vertex, alpha);
      }
      std::erase_if(shares, [&](const auto& share) { return !number.contains(share.first); });  // held by supports
      double sum = 0.0;
      for (const auto& [anchor, share] : shares) sum += share;
      for (const auto& [anchor, share] : shares) {
        const int at = number.at(anchor);
        result.emplace_back(int(multiplier.node), at, share / (sum * retained[std::size_t(at)].weight));
      }
    }
    return result;
  }

  void evaluate(const FacetQuadrature& facet, FacetMultipliers& result) const override {
    if (!facet.whole) {
      result.anchors.assign(facet.nodes, facet.nodes + facet.node_count());
      result.values = bernstein(facet) * *facet.displacement;
      return;
    }
    const Matrix basis = basis_change(facet) * *facet.displacement;
    const Vector weights = basis * facet.measure;
    const Matrix mass = basis * facet.measure.asDiagonal() * basis.transpose();
    result.anchors.assign(facet.nodes, facet.nodes + facet.node_count());
    result.values = weights.asDiagonal() * SmallCholesky(mass).solve(basis);
  }

 private:
  static constexpr double alpha = 0.2;

  /// `nodes`: those of a facet in 2D.
  [[nodiscard]] bool ends_on_axis(const Index* nodes) const {
    const Body& body = *patch().body;
    return is_on_axis(body, nodes[0]) || is_on_axis(body, nodes[1]);
  }

  /// Returns T on a facet.
  [[nodiscard]] Matrix basis_change(const FacetQuadrature& facet) const {
    Matrix result = Matrix::Identity(facet.node_count(), facet.node_count());
    if (transformed_.empty()) return result;
    const auto& vertices_of = node_vertices(facet.shape, 2);
    for (std::size_t k = 0; k < vertices_of.size(); ++k) {
      if (vertices_of[k].size() != 2 || !transformed_.contains(facet.nodes[k])) continue;
      const auto column = Index(k);
      result(column, column) = 1.0 - 2.0 * alpha;
      for (const int v : vertices_of[k]) result(v, column) = alpha;
    }
    return result;
  }

  /// Returns the Bernstein polynomials at the nodes: those of degree 2 are (1 − s)², 2s(1 − s), s² along an edge.
  [[nodiscard]] static Matrix bernstein(const FacetQuadrature& facet) {
    Matrix result = Matrix::Identity(facet.node_count(), facet.node_count());
    if (facet.node_count() == facet.vertex_count()) return result;
    const auto& vertices_of = node_vertices(facet.shape, 2);
    const auto is_between = [&](std::size_t inner, std::size_t outer) {
      return std::includes(vertices_of[outer].begin(), vertices_of[outer].end(), vertices_of[inner].begin(),
                           vertices_of[inner].end());
    };
    for (std::size_t at = 0; at < vertices_of.size(); ++at) {
      for (std::size_t k = 0; k < vertices_of.size(); ++k) {
        // A node at the mean of an edge's ends has half of its own polynomial and a quarter of theirs; an
        // inner node has the products.
        const double own = double(vertices_of[k].size()), all = double(vertices_of[at].size());
        result(Index(k), Index(at)) = is_between(k, at) ? own / (all * all) : 0.0;
      }
    }
    return result;
  }

  [[nodiscard]] std::vector<std::pair<Index, double>> trace_of(Index node) const {
    const auto middle = transformed_.find(node);
    if (middle == transformed_.end()) return {{node, 1.0}};
    const double scale = 1.0 / (1.0 - 2.0 * alpha);
    return {{node, scale}, {middle->second[0], -alpha * scale}, {middle->second[1], -alpha * scale}};
  }

  FacetIntegration integration_;
  std::map<Index, std::array<Index, 2>> transformed_;  ///< mid-side nodes of these edges, with their vertices
};

}  // namespace

MultiplierSpaceRegistration dual_multipliers() {
  return {"dual", {[](const ContactPatch& patch) { return std::make_unique<DualMultipliers>(patch); }}};
}

}  // namespace ricochet
