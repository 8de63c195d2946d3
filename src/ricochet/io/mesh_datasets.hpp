#pragma once

#include <vector>

#include "ricochet/io/frame_arrangement.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Mesh of a run as fixed datasets, which are the same in files of all formats:
///
///   /mesh/nodes (nodes × 3), /mesh/cells (cells × nodes in VTK's order, or XDMF's mixed list), /mesh/element (the
///   number of each cell in the mesh file), /mesh/contact_facets like cells if there are any.
namespace ricochet {

/// Datasets in this order.
[[nodiscard]] std::vector<FixedDataset> mesh_datasets(const DisplacementSpace& space, const ContactBoundary& contact);

/// Further datasets of VTKHDF's UnstructuredGrid, with second names (/VTKHDF/Points, …) for existing ones.
[[nodiscard]] std::vector<FixedDataset> vtkhdf_mesh_datasets(const DisplacementSpace& space);

/// Cells of one kind as VTKHDF datasets, without the points. `points`: number of points; `type`: VTK's number of the
/// cell type.
[[nodiscard]] std::vector<FixedDataset> vtkhdf_cell_datasets(Index points, const std::vector<int>& cells, int type,
                                                             int nodes_per_cell);

}  // namespace ricochet
