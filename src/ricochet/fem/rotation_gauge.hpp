#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file How far a displacement turns the cells of a body.
namespace ricochet {

/// Above this rotation of a cell, in rad, small strain no longer holds: it takes the rotation for a strain of half a
/// per cent.
inline constexpr double rotation_limit = 0.1;

/// Largest rotation of any cell, in rad, from the displacement gradient at its centre: the angle of the rotation
/// closest to I + ∇u in the sense of atan2(|axial part|, trace part), exact for a rigid rotation of any size below π.
/// Keeps references to the body's mesh and space.
class RotationGauge {
 public:
  explicit RotationGauge(const Body& body);
  [[nodiscard]] double largest(const Vector& displacement) const;

 private:
  struct Block {
    const CellBlock* cells = nullptr;
    /// Cells × nodes × dimension, physical gradients at the centre. Empty for straight simplices of degree 1: those are
    /// computed from the positions of the vertices, which takes no longer than reading them.
    std::vector<double> gradients;
    /// Of those: the first dofs of the nodes of one cell after another.
    std::vector<int> vertices;
  };
  int dimension_;
  const Points* positions_;
  std::vector<Block> blocks_;
};

}  // namespace ricochet
