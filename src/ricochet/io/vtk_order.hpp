#pragma once

#include <array>
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

/// Components of a symmetric tensor in VTK's order, xx, yy, zz, xy, yz, xz: each one's number in ours, xx, xy, xz, yy,
/// yz, zz, which is XDMF's.
constexpr std::array<int, 6> vtk_tensor_from_ours = {0, 3, 5, 1, 4, 2};

}  // namespace ricochet
