#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Taking the rigid part out of a displacement.
namespace ricochet {

/// Removes from a displacement, body by body, the translation and the infinitesimal rotation that fit it best.
/// Stiffness does not see either, but rounding does: K U of a body that has moved by 1 has an error of 10⁻¹⁶ |K|, far
/// above the forces of a stiff body's small strains.
class RigidMotion {
 public:
  /// Bodies are the connected components of the matrix's graph (nodes that share an entry). `nodes`: d × count.
  RigidMotion(const Points& nodes, const SparseMatrix& stiffness);

  /// `deformation` = displacement less its rigid part.
  void remove(const Vector& displacement, Vector& deformation) const;

 private:
  struct Body {
    std::vector<Index> nodes;
    Matrix
        inverse_inertia;  ///< of unit masses at the nodes: 1 × 1 in 2D, 3 × 3 in 3D; zero where a rotation is no motion
  };
  template <int d>
  void remove_in(const Vector& displacement, Vector& deformation) const;

  int dimension_ = 2;
  Points positions_;  ///< relative to the centre of the node's body
  std::vector<Body> bodies_;
};

}  // namespace ricochet
