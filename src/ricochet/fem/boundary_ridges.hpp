#pragma once

#include <array>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/mesh/boundary_facets.hpp"

/// @file Ridges between two facets of a body's boundary, and their angles.
namespace ricochet {

/// Vertex of the boundary in 2D, edge in 3D.
struct Ridge {
  std::array<Index, 2> nodes;              ///< of the space; in 2D the same one twice
  std::array<std::size_t, 2> facets;       ///< indices of the boundary facets on both sides
  std::array<Eigen::Vector3d, 2> normals;  ///< outward normals of the facets at the ridge
  /// Angle between the outward normals of the two facets, positive if the body is convex: π
  /// minus the angle inside the body.
  double angle = 0.0;
  double adjacent_angle = 0.0;  ///< largest |turn| of the other ridges of the two facets
};

/// Returns all ridges at which exactly two facets meet. `boundary` has facets of the space's cells; curved facets have
/// the normals of their curved geometry.
[[nodiscard]] std::vector<Ridge> boundary_ridges(const Body& body, const std::vector<CellFacet>& boundary);

/// Whether an angle is that of an edge of the body, as opposed to a ridge between facets that approximate a smooth
/// surface, where the angles are small or alike: 60° or more, or 30° and twice that of the adjacent ridges.
[[nodiscard]] bool is_sharp(double angle, double adjacent_angle);

}  // namespace ricochet
