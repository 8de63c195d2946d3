#include "ricochet/contact/mortar/corner_pairs.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "ricochet/base/angles.hpp"
#include "ricochet/contact/mortar/facet_surface.hpp"
#include "ricochet/contact/mortar/paired_surfaces.hpp"

namespace ricochet {

namespace {

constexpr double sharp = std::numbers::pi / 6.0;

}  // namespace

std::vector<Index> convex_corners(const Body& body, const std::vector<Index>& facets) {
  const FacetSurface surface(body, facets);
  std::map<Index, const FacetSurface::Facet*> facet_of;
  for (const FacetSurface::Facet& facet : surface.facets()) facet_of[facet.number] = &facet;
  std::vector<Index> result;
  for (const auto& [node, around] : facets_around_nodes(*body.space, facets)) {
    if (around.size() != 2) continue;
    const FacetSurface::Facet &one = *facet_of.at(around[0]), &other = *facet_of.at(around[1]);
    const FacetSurface::Vector3 normal = one.area_vector.normalized(), next = other.area_vector.normalized();
    if (angle_between(normal, next) > sharp && normal.dot(other.centre - one.centre) < 0.0) result.push_back(node);
  }
  return result;
}

std::optional<ContactPair> corner_pair(const Body& body, const ContactPair& pair) {
  if (!pair.large_sliding || pair.tied || pair.is_self() || body.mesh->dimension != 2) return {};
  if (convex_corners(body, pair.opposite_facets).empty()) return {};
  ContactPair corners = pair;
  corners.exchange_sides();
  corners.multipliers = "p1";
  corners.at_corners = true;
  return corners;
}

}  // namespace ricochet
