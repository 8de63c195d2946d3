#pragma once

#include <array>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/mesh/boundary_facets.hpp"

/// @file Where two facets of a body's boundary meet, and how sharply.
namespace ricochet {

/// A vertex of a plane body, an edge of one in space.
struct Ridge {
  std::array<Index, 2> nodes;              ///< of the space; in the plane the same one twice
  std::array<std::size_t, 2> facets;       ///< indices of the boundary facets on both sides
  std::array<Eigen::Vector3d, 2> normals;  ///< of these, outward, at the ridge
  /// Angle by which the outward normal turns from one facet to the other, positive where the body is convex: π less the
  /// angle inside the body.
  double turn = 0.0;
  double nearby = 0.0;  ///< largest size of the turn at the other ridges of the two facets
};

/// All at which exactly two of the facets meet. `boundary` are facets of the space's cells; curved ones have the
/// normals of their curved geometry.
[[nodiscard]] std::vector<Ridge> boundary_ridges(const Body& body, const std::vector<CellFacet>& boundary);

/// Whether a turn is that of an edge of the body and not of a smooth surface that facets stand for, at whose ridges
/// turns are small or alike: 60° or more, or 30° and twice that of the ridges nearby.
[[nodiscard]] bool is_sharp(double turn, double nearby);

}  // namespace ricochet
