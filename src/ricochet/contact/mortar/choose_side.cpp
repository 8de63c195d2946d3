#include "ricochet/contact/mortar/choose_side.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "ricochet/base/angles.hpp"
#include "ricochet/contact/mortar/facet_surface.hpp"
#include "ricochet/contact/mortar/normal_variation.hpp"

namespace ricochet {

namespace {

/// Ratio above which two sides differ.
constexpr double alike = 1.1;

/// Ratio above which variations of normals differ, and the variation above which forces are in error by more than some
/// per cent: both measured (docs/sliding.md).
constexpr double similar_variation = 1.25, doubtful_variation = 0.25;

/// Variation below which sides count as flat, in rad.
constexpr double flat = 1e-3;

/// Ratio of areas above which a surface is the smaller one, and the ratio of mesh sizes up to which this decides.
constexpr double smaller_from = 1.5, coarsest = 3.0;

struct Side {
  double size = 0.0;       ///< mean distance of nodes on the facets
  double curvature = 0.0;  ///< mean rotation of the normal per length from facet to facet
  double stiffness = 0.0;  ///< mean of Young's modulus behind the facets, weighted by area
  double area = 0.0;
};

/// Angle, in rad, above which neighbours meet at an edge.
constexpr double largest_bend = 0.26 * 3.14159265358979323846;

/// Mean, over facets that share a node, of the angle between their normals divided by the distance of their centres.
/// Neighbours at an angle above `most` count as coplanar.
double curvature_of(const Body& body, const FacetSurface& surface, double most) {
  std::map<Index, std::vector<std::size_t>> around;
  for (std::size_t k = 0; k < surface.facets().size(); ++k) {
    const IndexInBlocks location = locate_in_blocks(body.mesh->facets, surface.facets()[k].number);
    const CellBlock& block = body.mesh->facets[location.block];
    for (int v = 0; v < vertex_count(block.shape); ++v) around[block.cell(location.local)[v]].push_back(k);
  }
  constexpr double rounding = 1e-6;
  double sum = 0.0;
  Index count = 0;
  const auto add = [&](const FacetSurface::Facet& a, const FacetSurface::Facet& b) {
    const FacetSurface::Vector3 one = a.area_vector.normalized(), other = b.area_vector.normalized();
    const double angle = angle_between(one, other), distance = (a.centre - b.centre).norm();
    sum += angle > rounding && angle <= most && distance > 0.0 ? angle / distance : 0.0;
    ++count;
  };
  for (const auto& [node, facets] : around) {
    for (std::size_t i = 0; i < facets.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) add(surface.facets()[facets[j]], surface.facets()[facets[i]]);
    }
  }
  return count > 0 ? sum / double(count) : 0.0;
}

Side measure(const Body& body, const std::vector<Index>& facets,
             double most = std::numeric_limits<double>::infinity()) {
  const FacetSurface surface(body, facets);
  Side side;
  double& area = side.area;
  for (std::size_t k = 0; k < surface.facets().size(); ++k) {
    const FacetSurface::Facet& facet = surface.facets()[k];
    side.size += facet.size / body.space->degree;
    side.stiffness += facet.area * material_of(body, surface.cells()[k]).young();
    area += facet.area;
  }
  side.size /= double(std::max<std::size_t>(surface.facets().size(), 1));
  side.stiffness /= area;
  side.curvature = curvature_of(body, surface, most);
  return side;
}

}  // namespace

double distance_from_curved(const Body& body, const ContactPair& pair) {
  if (body.mesh->degree > 1) return 0.0;
  double result = 0.0;
  for (const std::vector<Index>* const facets : {&pair.facets, &pair.opposite_facets}) {
    const Side side = measure(body, *facets, largest_bend);  // edges do not approximate curves
    const double size = side.size * body.space->degree;      // of the facets, not of their node spacing
    result = std::max(result, 0.125 * side.curvature * size * size);
  }
  return result;
}

std::optional<SideDoubt> doubt_side(const Body& body, const ContactPair& pair) {
  if (pair.tied || pair.is_self()) return std::nullopt;
  const NormalVariation variation = normal_variation(body, pair.facets, pair.opposite_facets);
  if (!(variation.own_of_bends > doubtful_variation)) return std::nullopt;
  const double least = std::min(variation.own_of_bends, variation.opposite_of_bends);
  return SideDoubt{variation.own_of_bends, variation.opposite_of_bends,
                   variation.own_of_bends > similar_variation * variation.opposite_of_bends,
                   std::min(doubtful_variation / least, 1.0)};
}

SideChoice choose_side(const Body& body, const ContactPair& pair) {
  const Side one = measure(body, pair.facets), other = measure(body, pair.opposite_facets);
  const auto differ = [](double a, double b) { return std::max(a, b) > alike * std::min(a, b); };
  const auto choice = [](bool opposite, const char* what, double own, double others) {
    return SideChoice{
        opposite, fmt::format("{} ({:.3g} against {:.3g})", what, opposite ? others : own, opposite ? own : others)};
  };
  const NormalVariation variation =
      pair.tied ? NormalVariation{} : normal_variation(body, pair.facets, pair.opposite_facets);
  // Normals vary most at edges, and it is not known beforehand which edges come into contact: edges are excluded if the
  // forces would be inaccurate even without them.
  const bool by_bends = std::max(variation.own_of_bends, variation.opposite_of_bends) > doubtful_variation;
  const double own = by_bends ? variation.own_of_bends : variation.own,
               others = by_bends ? variation.opposite_of_bends : variation.opposite;
  if (std::max(own, others) > std::max(flat, similar_variation * std::min(own, others)))
    return choice(others < own, "normals vary less within its facets", own, others);
  if (pair.large_sliding && smaller_from * std::min(one.area, other.area) < std::max(one.area, other.area)) {
    const bool is_other = other.area < one.area;
    if ((is_other ? other.size : one.size) < coarsest * (is_other ? one.size : other.size))
      return choice(is_other, "its surface is smaller", one.area, other.area);
  }
  if (differ(one.size, other.size)) return choice(other.size < one.size, "its mesh is finer", one.size, other.size);
  if (differ(one.curvature, other.curvature))
    return choice(other.curvature > one.curvature, "it is more curved", one.curvature, other.curvature);
  if (differ(one.stiffness, other.stiffness))
    return choice(other.stiffness < one.stiffness, "it is softer", one.stiffness, other.stiffness);
  return {false, "both sides are alike"};
}

}  // namespace ricochet
