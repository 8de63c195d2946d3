#pragma once

#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/mesh/boundary_facets.hpp"

/// @file Bodies of a mesh: sets of cells that are connected by nodes or ties.
namespace ricochet {

/// Bodies are numbered 0, 1, … in the order of their first cells.
struct ConnectedBodies {
  int count = 0;
  std::vector<int> of_node;  ///< per node of the space
  std::vector<int> of_cell;  ///< per cell, numbered through all blocks
};

[[nodiscard]] ConnectedBodies find_connected_bodies(const DisplacementSpace& space);

/// Names of the bodies in messages: "the body" if there is only one; else body "ball" if the part "ball" is exactly
/// this body; else by the groups of cells that lie entirely within it, body "left", or body "core" and "shell";
/// body 0 if there is no such group.
[[nodiscard]] std::vector<std::string> names_of_bodies(const Mesh& mesh, const ConnectedBodies& bodies);

/// Diameter of the smallest ball around the nodes of each body.
[[nodiscard]] std::vector<double> body_diameters(const Body& body, const ConnectedBodies& bodies);

/// Time, per body, in which a compression wave crosses the smallest ball around it, at the speed of its slowest
/// material: an event at one end has reached the other end by then.
[[nodiscard]] std::vector<double> wave_crossing_times(const Body& body, const ConnectedBodies& bodies);

/// Properties of the bodies of a mesh: of the whole mesh, even if only a part of it is on this rank.
struct BodiesOfMesh {
  ConnectedBodies connected;
  std::vector<std::string> names;
  std::vector<double> crossing_times;  ///< wave_crossing_times
  std::vector<double> sizes;           ///< body_diameters
  std::vector<CellFacet> boundary;     ///< of the local cells of the space
};
[[nodiscard]] BodiesOfMesh describe_bodies(const Body& body);

/// Times in which a compression wave crosses the height of each cell, ascending.
[[nodiscard]] std::vector<double> cell_crossing_times(const Body& body);
/// Median of these times for the cells of each material.
[[nodiscard]] std::vector<double> median_crossing_times(const Body& body);

}  // namespace ricochet
