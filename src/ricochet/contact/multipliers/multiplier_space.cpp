#include "ricochet/contact/multipliers/multiplier_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ricochet {

// The spaces, each by the registration function of its own file. One line each, in the order of the documentation.
// clang-format off
#define RICOCHET_MULTIPLIER_SPACES(space) \
  space(nodal_multipliers)                \
  space(p0_multipliers)                   \
  space(p1_multipliers)                   \
  space(dual_multipliers)
// clang-format on

RICOCHET_DEFINE_REGISTRY(multiplier_space_registry, MultiplierSpaceType, "multipliers", RICOCHET_MULTIPLIER_SPACES)

std::unique_ptr<MultiplierSpace> make_multiplier_space(const std::string& name, const ContactPatch& patch) {
  return multiplier_space_registry().find(name).type.make(patch);
}

MultiplierAnchor anchor_of(const std::string& multipliers) {
  return multiplier_space_registry().find(multipliers).type.anchor;
}

std::string instability(const std::string& multipliers, CellShape facet, int displacement_degree) {
  const MultiplierSpaceType& space = multiplier_space_registry().find(multipliers).type;
  return space.instability ? space.instability(facet, displacement_degree) : std::string();
}

bool only_presses_supports(const Multiplier& multiplier, const ContactPatch& patch) {
  if (!patch.is_supported) return false;
  if (multiplier.node >= 0) return patch.is_supported(multiplier.node);
  return std::ranges::all_of(multiplier.trace, [&](const auto& entry) { return patch.is_supported(entry.first); });
}

std::vector<Multiplier> integrate_multipliers(const MultiplierSpace& space, MultiplierAnchor anchored) {
  const bool at_facets = anchored == MultiplierAnchor::facet;
  struct Sums {
    Multiplier multiplier;
    std::map<Index, double> integrals;  // ∫ψ_i φ_j
  };
  std::map<Index, Sums> by_anchor;
  const FacetIntegration integration(*space.patch().body);
  FacetQuadrature quadrature;
  FacetMultipliers functions;
  for (const ContactPatch::Part& part : space.patch().parts) {
    for (const Index facet : part.facets) {
      integration.evaluate(facet, quadrature);
      space.evaluate(quadrature, functions);
      const Matrix weighted = functions.values * quadrature.measure.asDiagonal();
      const Matrix products = weighted * quadrature.displacement->transpose();
      for (std::size_t k = 0; k < functions.anchors.size(); ++k) {
        const Index anchor = functions.anchors[k];
        const auto [entry, added] = by_anchor.try_emplace(anchor);
        Sums& sums = entry->second;
        if (added) sums.multiplier = {part.pair, at_facets ? -1 : anchor, at_facets ? anchor : -1, 0.0, {}};
        sums.multiplier.weight += weighted.row(Index(k)).sum();
        for (Index j = 0; j < quadrature.node_count(); ++j) {
          sums.integrals[quadrature.nodes[j]] += products(Index(k), j);
        }
      }
    }
  }
  std::vector<Multiplier> result;
  for (auto& [anchor, sums] : by_anchor) {
    double largest = 0.0;
    for (const auto& [node, value] : sums.integrals) largest = std::max(largest, std::abs(value));
    for (const auto& [node, value] : sums.integrals) {
      const bool vanishes = std::abs(value) <= 64.0 * std::numeric_limits<double>::epsilon() * largest;
      sums.multiplier.trace.emplace_back(node, vanishes ? 0.0 : value / sums.multiplier.weight);
    }
    result.push_back(std::move(sums.multiplier));
  }
  return result;
}

}  // namespace ricochet
