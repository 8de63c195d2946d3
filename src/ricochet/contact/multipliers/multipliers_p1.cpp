#include <map>
#include <set>

#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

/// One multiplier per vertex, continuous: ψ_v is the (multi)linear hat function of the vertex, for any degree of the
/// displacement. Constrained vertices have no multiplier; the hats of the constrained vertices of a facet are
/// distributed equally to its others, so that Σψ = 1 up to the support and a uniform pressure remains in the space.
/// Pressures at nodes are λ_v at vertices (0 at constrained ones) and the mean over the vertices at mid-side nodes.
class P1Multipliers final : public MultiplierSpace {
 public:
  using MultiplierSpace::MultiplierSpace;

  [[nodiscard]] std::vector<Multiplier> multipliers() const override {
    return integrate_multipliers(*this, MultiplierAnchor::node);
  }

  [[nodiscard]] std::vector<Eigen::Triplet<double>> pressure_recovery(
      const std::vector<Multiplier>& retained) const override {
    std::map<Index, int> number;
    for (std::size_t i = 0; i < retained.size(); ++i) number[retained[i].node] = int(i);
    const DisplacementSpace& space = *patch().body->space;
    std::set<Index> done;
    std::vector<Eigen::Triplet<double>> result;
    for (const ContactPatch::Part& part : patch().parts) {
      for (const Index facet : part.facets) {
        const IndexInBlocks location = locate_facet(space, facet);
        const CellBlock& block = space.facets[location.block];
        const Index* nodes = block.cell(location.local);
        const auto& vertices_of = node_vertices(block.shape, space.degree);
        for (std::size_t k = 0; k < vertices_of.size(); ++k) {
          const Index node = nodes[k];
          if (!done.insert(node).second) continue;
          std::vector<int> retained_vertices;
          for (const int v : vertices_of[k]) {
            const auto vertex = number.find(nodes[v]);
            if (vertex != number.end()) retained_vertices.push_back(vertex->second);
          }
          for (const int vertex : retained_vertices) {
            const double weight = retained[std::size_t(vertex)].weight;
            result.emplace_back(int(node), vertex, 1.0 / (weight * double(retained_vertices.size())));
          }
        }
      }
    }
    return result;
  }

  void evaluate(const FacetQuadrature& facet, FacetMultipliers& result) const override {
    result.anchors.clear();
    std::vector<Index> free;
    Eigen::RowVectorXd supported = Eigen::RowVectorXd::Zero(facet.measure.size());
    for (Index v = 0; v < facet.vertex_count(); ++v) {
      if (is_supported(facet.nodes[v])) {
        supported += facet.hats->row(v);
        continue;
      }
      free.push_back(v);
      result.anchors.push_back(facet.nodes[v]);
    }
    result.values.resize(Index(free.size()), facet.measure.size());
    for (std::size_t k = 0; k < free.size(); ++k) {
      result.values.row(Index(k)) = facet.hats->row(free[k]) + supported / double(free.size());
    }
  }
};

}  // namespace

MultiplierSpaceRegistration p1_multipliers() {
  return {"p1", {[](const ContactPatch& patch) { return std::make_unique<P1Multipliers>(patch); }}};
}

}  // namespace ricochet
