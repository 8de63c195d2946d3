#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Largest rotation of the cells of a body by a displacement.
namespace ricochet {

/// Rotation of a cell, in rad, above which small strain is invalid: it mistakes the rotation for a strain of half a per
/// cent.
inline constexpr double rotation_limit = 0.1;

/// Largest rotation of any cell, in rad, from the displacement gradient at its centre: the angle of the rotation
/// closest to I + ∇u in the sense of atan2(|axial part|, trace part), exact for a rigid rotation of any size below π.
/// Keeps references to the body's mesh and space.
class CellRotations {
 public:
  explicit CellRotations(const Body& body);
  [[nodiscard]] double largest(const Vector& displacement) const;

 private:
  struct Block {
    const CellBlock* cells = nullptr;
    /// Physical gradients at the centre, cells × nodes × dimension. Empty for straight simplices of degree 1: they are
    /// computed from the positions of the vertices, which is as fast as reading them.
    std::vector<double> gradients;
    /// For those simplices: the first dofs of the nodes, cell by cell.
    std::vector<int> vertices;
  };
  int dimension_;
  const Points* positions_;
  std::vector<Block> blocks_;
};

}  // namespace ricochet
