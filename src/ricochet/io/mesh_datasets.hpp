#pragma once

#include <vector>

#include "ricochet/io/frame_arrangement.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The mesh of a run as fixed data sets, the same in files of all formats:
///
///   /mesh/nodes (nodes × 3), /mesh/cells (cells × nodes in VTK's order, or XDMF's mixed list), /mesh/element (the
///   number of each cell in the mesh file), /mesh/contact_facets like cells where there are any.
namespace ricochet {

/// In this order.
[[nodiscard]] std::vector<FixedDataset> mesh_datasets(const DisplacementSpace& space, const ContactBoundary& contact);

/// What VTKHDF's UnstructuredGrid wants besides, with names of its own (/VTKHDF/Points, …) for what is there already.
[[nodiscard]] std::vector<FixedDataset> vtkhdf_mesh_datasets(const DisplacementSpace& space);

/// Cells of one kind in VTKHDF's terms. `points`: how many there are; `type`: VTK's number of the cells, which have so
/// many nodes each; without the points themselves.
[[nodiscard]] std::vector<FixedDataset> vtkhdf_cell_datasets(Index points, const std::vector<int>& cells, int type,
                                                             int nodes_per_cell);

}  // namespace ricochet
