#pragma once

#include <array>
#include <string>
#include <vector>

#include "ricochet/mesh/cell_type.hpp"

/// @file Node order and names of cells in VTK and XDMF.
namespace ricochet {

struct VtkCell {
  std::string xdmf_name;       ///< TopologyType
  int xdmf_number = 0;         ///< in Mixed topologies
  int vtk_number = 0;          ///< as in vtkCellType.h
  std::vector<int> from_ours;  ///< per VTK node, its number in Basix's order
};

[[nodiscard]] VtkCell vtk_cell(CellShape shape, int degree);

/// For each component of a symmetric tensor in VTK's order, xx, yy, zz, xy, yz, xz, its index in ours, xx, xy, xz, yy,
/// yz, zz, which is XDMF's.
constexpr std::array<int, 6> vtk_tensor_from_ours = {0, 3, 5, 1, 4, 2};

}  // namespace ricochet
