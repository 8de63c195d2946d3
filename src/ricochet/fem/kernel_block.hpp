#pragma once

#include <vector>

#include "ricochet/base/packs.hpp"
#include "ricochet/fem/cell_integration.hpp"

/// @file Constant data of the cells of a block. Not part of the public interface.
namespace ricochet {

/// Shape functions, and the inverse Jacobian and the weight at every quadrature point (for straight simplices one
/// Jacobian per cell). In an axisymmetric body a weight is that of the ring swept by a point, and the displacement
/// gradient includes the hoop stretch u_r/r.
///
/// Numbers of the cells are in the order of CellPacks: `width` of them per pack and point.
template <int d>
struct KernelBlock {
  BlockIntegration integration;
  bool affine = false;
  Matrix dilatation_functions = {};  ///< points × functions; empty if there is no mean dilatation
  int nodes = 0, points = 0, width = 0;

  std::vector<double> gradients = {};  ///< of the shape functions in reference coordinates: points × nodes × d
  std::vector<double> inverse = {};    ///< d × d numbers, row by row, per point or, if the map is affine, per pack
  std::vector<double> weight = {};     ///< per point
  std::vector<double> radius = {};     ///< per point in axisymmetric bodies; else empty
  std::vector<int> lane = {};          ///< per cell: pack · width + lane; −1: in no pack

  [[nodiscard]] bool is_axisymmetric() const { return !radius.empty(); }
  /// Whether shape functions are 1 − Σξ, ξ₁, …, so that differences between nodes are derivatives.
  [[nodiscard]] bool is_linear_simplex() const { return affine && nodes == d + 1; }
  [[nodiscard]] const double* inverse_of_pack(Index pack, int q) const {
    return inverse.data() + d * d * width * (affine ? pack : pack * points + q);
  }
  /// Index of a point of a pack in `weight` and `radius`.
  [[nodiscard]] Index index(Index pack, int q) const { return (pack * points + q) * width; }
};

}  // namespace ricochet
