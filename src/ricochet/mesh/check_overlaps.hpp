#pragma once

#include "ricochet/mesh/mesh.hpp"

/// @file Cells that overlap although none is inverted.
namespace ricochet::gmsh {

/// Warns if the cells around a node fill more than the full angle there (2π; in space the solid angle 4π), naming the
/// worst node and its position. `mesh`: cells with positive Jacobians. Overlaps that do not show at a common vertex of
/// the cells are not found.
void warn_of_overlaps(const Mesh& mesh);

}  // namespace ricochet::gmsh
