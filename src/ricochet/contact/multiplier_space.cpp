#include "ricochet/contact/multiplier_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

struct SpaceRegistration {
  std::string name;
  std::function<std::unique_ptr<MultiplierSpace>(const ContactPatch&)> make;
  MultiplierAnchor anchor = MultiplierAnchor::node;
  std::function<std::string(CellShape, int)> instability = {};  ///< as the function of that name; empty: stable
};

const std::vector<SpaceRegistration>& space_registrations() {
  static const std::vector<SpaceRegistration> all{
      {"nodal", make_nodal_multipliers},
      {"p0", make_p0_multipliers, MultiplierAnchor::facet, p0_instability},
      {"p1", make_p1_multipliers},
      {"dual", make_dual_multipliers},
  };
  return all;
}

const SpaceRegistration& registration(const std::string& name) {
  for (const SpaceRegistration& entry : space_registrations()) {
    if (entry.name == name) return entry;
  }
  throw Error(ErrorKind::invalid_input,
              fmt::format("unknown multipliers \"{}\"; known: {}", name, join_names(multiplier_space_names())));
}

}  // namespace

std::vector<std::string> multiplier_space_names() {
  std::vector<std::string> names;
  for (const SpaceRegistration& entry : space_registrations()) names.push_back(entry.name);
  return names;
}

std::unique_ptr<MultiplierSpace> make_multiplier_space(const std::string& name, const ContactPatch& patch) {
  return registration(name).make(patch);
}

MultiplierAnchor anchor_of(const std::string& multipliers) {
  return registration(multipliers).anchor;
}

std::string instability(const std::string& multipliers, CellShape facet, int displacement_degree) {
  const SpaceRegistration& space = registration(multipliers);
  return space.instability ? space.instability(facet, displacement_degree) : std::string();
}

bool is_stable(const std::string& multipliers, CellShape facet, int displacement_degree) {
  return instability(multipliers, facet, displacement_degree).empty();
}

bool only_presses_supports(const Multiplier& multiplier, const ContactPatch& patch) {
  if (!patch.is_held) return false;
  if (multiplier.node >= 0) return patch.is_held(multiplier.node);
  return std::all_of(multiplier.trace.begin(), multiplier.trace.end(),
                     [&](const auto& entry) { return patch.is_held(entry.first); });
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
        sums.multiplier.weight += weighted.row(static_cast<Index>(k)).sum();
        for (Index j = 0; j < quadrature.node_count(); ++j) {
          sums.integrals[quadrature.nodes[j]] += products(static_cast<Index>(k), j);
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
