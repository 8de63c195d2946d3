#pragma once

#include <string>
#include <vector>

#include "ricochet/mesh/cell_type.hpp"

/// @file Cells as VTK and XDMF number and name them.
namespace ricochet {

struct VtkCell {
  std::string xdmf_name;       ///< TopologyType
  int xdmf_number = 0;         ///< in Mixed topologies
  int vtk_number = 0;          ///< of VTK's own, as in vtkCellType.h
  std::vector<int> from_ours;  ///< for each VTK node, its number in Basix's order
};

[[nodiscard]] VtkCell vtk_cell(CellShape shape, int degree);

}  // namespace ricochet
