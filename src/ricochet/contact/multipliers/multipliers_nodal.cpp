#include <map>

#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// Computes ∫ φ_i over facets, for all nodes of the space.
Vector nodal_weights(const Body& body, const std::vector<Index>& facets) {
  Vector weights = Vector::Zero(body.space->node_count());
  const FacetIntegration integration(body);
  FacetQuadrature quadrature;
  for (const Index facet : facets) {
    integration.evaluate(facet, quadrature);
    for (Index q = 0; q < quadrature.measure.size(); ++q) {
      for (Index k = 0; k < quadrature.node_count(); ++k)
        weights[quadrature.nodes[k]] += quadrature.measure[q] * (*quadrature.displacement)(k, q);
    }
  }
  return weights;
}

/// Returns for each non-vertex node of the facets the vertices between which it lies.
std::map<Index, std::vector<Index>> middle_nodes(const DisplacementSpace& space, const std::vector<Index>& facets) {
  std::map<Index, std::vector<Index>> middles;
  for (const Index facet : facets) {
    const IndexInBlocks location = locate_facet(space, facet);
    const CellBlock& block = space.facets[location.block];
    const Index* nodes = block.cell(location.local);
    const auto& support = node_vertices(block.shape, space.degree);
    for (std::size_t k = 0; k < support.size(); ++k) {
      if (support[k].size() == 1) continue;
      std::vector<Index>& vertices = middles[nodes[k]];
      vertices.clear();
      for (const int v : support[k]) vertices.push_back(nodes[v]);
    }
  }
  return middles;
}

/// Forces at nodes: c is the identity, and the gap is that of the node itself.
///
/// Pressure from nodal forces. With degree 1: p_i = r_i / ∫φ_i. With degree 2 vertex weights are smaller than those of
/// the mid-side nodes and vanish on flat triangles, so forces are first gathered on the linear hat functions ψ_a of the
/// vertices: p_a = Σ_j ψ_a(x_j) r_j / ∫ψ_a, and a node between vertices has the mean over the vertices of its edge or
/// face. This is exact for a uniform pressure, preserves the sign, and Σ_a p_a ∫ψ_a is the total force.
class NodalMultipliers final : public MultiplierSpace {
 public:
  using MultiplierSpace::MultiplierSpace;

  [[nodiscard]] std::vector<Multiplier> multipliers() const override {
    const Body& body = *patch().body;
    std::map<Index, Multiplier> by_node;
    for (const ContactPatch::Part& part : patch().parts) {
      const Vector weights = nodal_weights(body, part.facets);
      for (const Index node : facet_nodes(*body.space, part.facets)) {
        const auto [entry, added] = by_node.try_emplace(node);
        Multiplier& multiplier = entry->second;
        if (added) multiplier = {part.pair, node, -1, 0.0, {{node, 1.0}}};
        multiplier.weight += weights[node];
      }
    }
    std::vector<Multiplier> result;
    for (const auto& [node, multiplier] : by_node) result.push_back(multiplier);
    return result;
  }

  [[nodiscard]] std::vector<Eigen::Triplet<double>> pressure_recovery(
      const std::vector<Multiplier>& retained) const override {
    const auto count = Index(retained.size());
    std::map<Index, Index> number;
    Vector own_weights(count);
    for (Index i = 0; i < count; ++i) {
      number[retained[std::size_t(i)].node] = i;
      own_weights[i] = retained[std::size_t(i)].weight;
    }
    // gathering(a, j) = ψ_a(x_j): the identity with degree 1.
    SparseRowMatrix gathering(count, count), spreading(count, count);
    fill_gathering(number, gathering, spreading);
    const Vector weights = gathering * own_weights;
    for (Index row = 0; row < count; ++row) {
      for (SparseRowMatrix::InnerIterator entry(gathering, row); entry; ++entry) entry.valueRef() /= weights[row];
    }
    const SparseRowMatrix recovery = spreading * gathering;
    std::vector<Eigen::Triplet<double>> result;
    for (Index row = 0; row < count; ++row) {
      for (SparseRowMatrix::InnerIterator entry(recovery, row); entry; ++entry) {
        result.emplace_back(int(retained[std::size_t(row)].node), int(entry.col()), entry.value());
      }
    }
    return result;
  }

  [[nodiscard]] bool has_functions() const override { return false; }
  /// The L² representatives of the forces are the shape functions of the displacement.
  void evaluate(const FacetQuadrature& facet, FacetMultipliers& result) const override {
    result.anchors.assign(facet.nodes, facet.nodes + facet.node_count());
    result.values = *facet.displacement;
  }

 private:
  void fill_gathering(const std::map<Index, Index>& number, SparseRowMatrix& gathering,
                      SparseRowMatrix& spreading) const {
    std::vector<Eigen::Triplet<double>> gather, spread;
    std::vector<char> is_middle(number.size(), 0);
    for (const ContactPatch::Part& part : patch().parts) {
      for (const auto& [node, vertices] : middle_nodes(*patch().body->space, part.facets)) {
        const auto point = number.find(node);
        if (point == number.end() || is_middle[std::size_t(point->second)] != 0) continue;
        std::vector<Index> retained_vertices;
        for (const Index vertex : vertices) {
          const auto found = number.find(vertex);
          if (found != number.end()) retained_vertices.push_back(found->second);
        }
        // If supports have removed the vertices, the mid-side node keeps its own force.
        is_middle[std::size_t(point->second)] = retained_vertices.empty() ? 0 : 1;
        for (const Index vertex : retained_vertices) {
          const double share = 1.0 / double(retained_vertices.size());
          gather.emplace_back(int(vertex), int(point->second), share);
          spread.emplace_back(int(point->second), int(vertex), share);
        }
      }
    }
    for (std::size_t i = 0; i < is_middle.size(); ++i) {
      if (is_middle[i] != 0) continue;
      gather.emplace_back(int(i), int(i), 1.0);
      spread.emplace_back(int(i), int(i), 1.0);
    }
    gathering.setFromTriplets(gather.begin(), gather.end());
    spreading.setFromTriplets(spread.begin(), spread.end());
  }
};

}  // namespace

MultiplierSpaceRegistration nodal_multipliers() {
  return {"nodal", {[](const ContactPatch& patch) { return std::make_unique<NodalMultipliers>(patch); }}};
}

}  // namespace ricochet
