#include <map>

#include "ricochet/contact/multipliers/multiplier_space.hpp"

namespace ricochet {

namespace {

/// One multiplier per facet, constant on it: ψ_e = 1, D_e = |e|, c_ej = (1/|e|) ∫_e φ_j. The pressure at a node is the
/// mean of its facets' pressures, weighted by their areas.
class P0Multipliers final : public MultiplierSpace {
 public:
  using MultiplierSpace::MultiplierSpace;

  [[nodiscard]] std::vector<Multiplier> multipliers() const override {
    return integrate_multipliers(*this, MultiplierAnchor::facet);
  }

  [[nodiscard]] std::vector<Eigen::Triplet<double>> pressure_recovery(
      const std::vector<Multiplier>& retained) const override {
    std::map<Index, double> area;  // of the facets at a node
    for (const Multiplier& multiplier : retained) {
      for (const auto& [node, weight] : multiplier.trace) area[node] += multiplier.weight;
    }
    std::vector<Eigen::Triplet<double>> result;
    for (std::size_t i = 0; i < retained.size(); ++i) {
      for (const auto& [node, weight] : retained[i].trace) {
        result.emplace_back(int(node), int(i), 1.0 / area.at(node));
      }
    }
    return result;
  }

  void evaluate(const FacetQuadrature& facet, FacetMultipliers& result) const override {
    result.anchors.assign(1, facet.facet);
    result.values.setOnes(1, facet.measure.size());
  }
};

/// Reason of the instability of p0, empty if it is stable: see instability().
std::string p0_instability(CellShape facet, int displacement_degree) {
  if (displacement_degree == 1) {
    return "multipliers \"p0\" are not inf-sup stable with displacements of degree 1: pressures that alternate from "
           "facet to facet do next to no work on them; use degree 2, or \"p1\", \"dual\" or \"nodal\"";
  }
  if (facet == CellShape::triangle) {
    return "multipliers \"p0\" are not inf-sup stable on triangular facets of degree 2, which have no node inside: "
           "pressures that alternate from triangle to triangle do next to no work; use \"p1\", \"dual\" or \"nodal\"";
  }
  return {};
}

}  // namespace

MultiplierSpaceRegistration p0_multipliers() {
  return {"p0",
          {[](const ContactPatch& patch) { return std::make_unique<P0Multipliers>(patch); }, MultiplierAnchor::facet,
           p0_instability}};
}

}  // namespace ricochet
