#pragma once

#include "ricochet/mesh/mesh.hpp"

/// @file Cells that lie on one another though no cell is inside out.
namespace ricochet::gmsh {

/// Warns where the cells around a node take up more than the whole angle there (2π; in space the solid angle 4π), with
/// the worst node and its place. `mesh`: cells with positive Jacobians. Cells that overlap without a common vertex at
/// which they do are not found.
void warn_of_overlaps(const Mesh& mesh);

}  // namespace ricochet::gmsh
