#pragma once

#include <vector>

#include "ricochet/base/node_order.hpp"
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
  /// The same with the nodes of the result in another order: its dofs i·d … are those of order.node[i].
  void remove(const Vector& displacement, const NodeOrder& order, Vector& deformation) const;

 private:
  struct Body {
    /// Ascending; empty when they are all nodes there are.
    std::vector<Index> nodes;
    Index count = 0;
    /// Of unit masses at the nodes: 1 × 1 in 2D, 3 × 3 in 3D; zero where a rotation is no motion.
    Matrix inverse_inertia;
    Vector position_sum;  ///< Σ of the relative positions: zero to rounding
  };
  /// u = translation + rotation × relative position (in 2D the rotation is its last component).
  struct Motion {
    Eigen::Vector3d translation = Eigen::Vector3d::Zero(), rotation = Eigen::Vector3d::Zero();
  };
  template <int d>
  void fit(const Vector& displacement) const;
  template <int d, class NodeAt>
  void remove_in(const Vector& displacement, const NodeAt& node_at, Vector& deformation) const;

  int dimension_ = 2;
  Points positions_;  ///< relative to the centre of the node's body
  std::vector<Body> bodies_;
  std::vector<int> body_of_node_;        ///< empty with one body
  mutable std::vector<Motion> motions_;  ///< per body, of the displacement last seen
};

}  // namespace ricochet
