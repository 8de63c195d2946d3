#pragma once

#include <vector>

#include "ricochet/base/packs.hpp"
#include "ricochet/fem/cell_integration.hpp"

/// @file What is constant of the cells of a block. Not part of the public interface.
namespace ricochet {

/// Shape functions, and the inverse Jacobian with the weight of every quadrature point (of straight simplices one
/// Jacobian for all). Of an axisymmetric body a weight is of the ring that a point sweeps, and the displacement's
/// gradient has the stretch u_r/r along it.
///
/// Numbers of the cells are in the order of CellPacks: per pack and point `width` of each.
template <int d>
struct KernelBlock {
  BlockIntegration integration;
  bool affine = false;
  Matrix dilatation_functions = {};  ///< points × functions; empty: no mean dilatation
  int nodes = 0, points = 0, width = 0;

  std::vector<double> gradients = {};  ///< of the shape functions by reference coordinates: points × nodes × d
  std::vector<double> inverse = {};    ///< d × d numbers, row by row, per point or, where the map is affine, per pack
  std::vector<double> weight = {};     ///< per point
  std::vector<double> radius = {};     ///< per point, of an axisymmetric body; else empty
  std::vector<int> lane = {};          ///< per cell: pack · width + lane; −1: in no pack

  [[nodiscard]] bool is_axisymmetric() const { return !radius.empty(); }
  /// Shape functions 1 − Σξ, ξ₁, …: differences of nodes are derivatives.
  [[nodiscard]] bool is_linear_simplex() const { return affine && nodes == d + 1; }
  [[nodiscard]] const double* inverse_of_pack(Index pack, int q) const {
    return inverse.data() + d * d * width * (affine ? pack : pack * points + q);
  }
  /// Of a point of a pack in `weight` and `radius`.
  [[nodiscard]] Index place(Index pack, int q) const { return (pack * points + q) * width; }
};

}  // namespace ricochet
