#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Removal of the rigid part of a displacement.
namespace ricochet {

/// Removes from a displacement, body by body, the translation and the infinitesimal rotation that fit it best. In exact
/// arithmetic the stiffness maps both to zero, but in floating point K U of a body that has moved by 1 has an error of
/// 10⁻¹⁶ |K|, far above the forces of a stiff body's small strains. If the stiffness does not map rotations to zero
/// (linear functions on curved cells do not contain them), only translations are removed; of an axisymmetric body not
/// the translation away from the axis, which strains its rings.
class RigidMotion {
 public:
  /// Takes the connected components of the graph of K (nodes that share an entry) as bodies. `nodes`: d × count.
  RigidMotion(const Points& nodes, const SparseMatrix& stiffness);

  /// Computes `deformation` = displacement minus its rigid part.
  void remove(const Vector& displacement, Vector& deformation) const;
  /// Product of a force per dof with the deformation, which is not stored.
  [[nodiscard]] double work(const Vector& force, const Vector& displacement) const;

 private:
  /// Upper bound on the nodes to which the motion of a body is fitted. The fit need not be optimal, because
  /// the remainder of a rigid motion is of the size of the deformation; a fit to all nodes would cost
  /// another pass over all of them.
  static constexpr Index most_fitted = 1024;

  struct Body {
    std::vector<int> fitted;  ///< nodes
    Points positions;         ///< of the fitted nodes, relative to their centre
    Vector position_sum;      ///< Σ of the positions: zero to rounding
    Vector centre;
    /// Inverse inertia of unit masses at the fitted nodes: 1 × 1 in 2D, 3 × 3 in 3D; zero if rotations are not removed.
    Matrix inverse_inertia;
    bool moves_across = true;  ///< along x; false if that strains the body
  };
  /// u = translation + rotation × position (in 2D the rotation is its last component).
  struct Motion {
    Eigen::Vector3d translation = Eigen::Vector3d::Zero(), rotation = Eigen::Vector3d::Zero();
  };
  void find_bodies(const Points& nodes, const SparseMatrix& stiffness);
  /// Marks the nodes at which the stiffness force of a motion exceeds rounding.
  [[nodiscard]] std::vector<char> strained_by(const Vector& motion, const SparseMatrix& stiffness) const;
  [[nodiscard]] std::size_t body_of(std::size_t node) const;
  void select_rotations_that_strain(const SparseMatrix& stiffness);
  void select_translations_that_strain(const SparseMatrix& stiffness);
  static Body make_body(const Points& nodes, const std::vector<Index>& members);
  template <int d>
  Motion fit(const Body& body, const Vector& displacement) const;
  template <int d>
  void fit_bodies(const Vector& displacement) const;
  template <int d>
  [[nodiscard]] Eigen::Matrix<double, d, 1> rigid_part(Index node) const;
  template <int d>
  void remove_in(const Vector& displacement, Vector& deformation) const;
  template <int d>
  [[nodiscard]] double work_in(const Vector& force, const Vector& displacement) const;

  int dimension_ = 2;
  Points positions_;  ///< relative to the centre of the node's body
  std::vector<Body> bodies_;
  std::vector<int> body_of_node_;        ///< empty with one body
  mutable std::vector<Motion> motions_;  ///< per body, fitted to the last displacement
};

}  // namespace ricochet
