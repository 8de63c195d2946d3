#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/fem/reference_element.hpp"

/// @file Volumes at the vertices of cells.
namespace ricochet {

/// Volume ratios det(I + ∇u) at the vertices of cells. Laws are evaluated at quadrature points inside the cells: a cell
/// of degree 2 may be turned inside out at a vertex without an effect on its energy.
class VertexVolumes {
 public:
  struct Smallest {
    double ratio = 1.0;
    Index cell = -1;  ///< numbered through all blocks; −1: no ratio is below 1
  };

  /// Keeps the pointers of the body.
  explicit VertexVolumes(const Body& body);
  /// The smallest ratio at a displacement. Allocates nothing. In axisymmetric bodies the ratio is that of areas.
  [[nodiscard]] Smallest smallest(const Vector& displacement) const;

 private:
  template <int d>
  void add_block(std::size_t block, Index first_cell, const Vector& displacement, Smallest& result) const;

  Body body_;
  std::vector<Tabulation> geometry_, displacement_;  ///< per block, at the vertices
};

}  // namespace ricochet
