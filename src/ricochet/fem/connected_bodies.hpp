#pragma once

#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/mesh/boundary_facets.hpp"

/// @file The bodies of a mesh: sets of cells that hang together by nodes, or are tied.
namespace ricochet {

/// Bodies have the numbers 0, 1, … in the order of their first cells.
struct ConnectedBodies {
  int count = 0;
  std::vector<int> of_node;  ///< per node of the space
  std::vector<int> of_cell;  ///< per cell, numbered through all blocks
};

[[nodiscard]] ConnectedBodies find_connected_bodies(const DisplacementSpace& space);

/// What messages call each: "the body" where there is one; else body "ball", where all of it and nothing else is in the
/// part "ball"; else, by the groups of cells that no other body has a part in, body "left", or body "core" and "shell";
/// and body 0 where there is no such group.
[[nodiscard]] std::vector<std::string> names_of_bodies(const Mesh& mesh, const ConnectedBodies& bodies);

/// Per body: the diameter of the smallest ball around its nodes.
[[nodiscard]] std::vector<double> body_diameters(const Body& body, const ConnectedBodies& bodies);

/// Per body: the time in which a compression wave crosses the smallest ball around it, at the speed of its slowest
/// material. By then what happens at one end is known at the other one.
[[nodiscard]] std::vector<double> wave_crossing_times(const Body& body, const ConnectedBodies& bodies);

/// What a run asks about the bodies of its mesh: of the whole, whatever part of it is here.
struct BodiesOfMesh {
  ConnectedBodies connected;
  std::vector<std::string> names;
  std::vector<double> crossing_times;  ///< wave_crossing_times
  std::vector<double> sizes;           ///< body_diameters
  std::vector<CellFacet> boundary;     ///< of the space's cells that are here
};
[[nodiscard]] BodiesOfMesh describe_bodies(const Body& body);

/// Times that a compression wave takes through the height of cells, ascending.
[[nodiscard]] std::vector<double> cell_crossing_times(const Body& body);

}  // namespace ricochet
