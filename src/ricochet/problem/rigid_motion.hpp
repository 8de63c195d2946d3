#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Taking the rigid part out of a displacement.
namespace ricochet {

/// Removes from a displacement, body by body, the translation and the infinitesimal rotation that fit it best.
/// Stiffness does not see either, but rounding does: K U of a body that has moved by 1 has an error of 10⁻¹⁶ |K|, far
/// above the forces of a stiff body's small strains. Where the stiffness does see rotations (linear functions on curved
/// cells do not contain them), translations alone are removed; of these not that away from the axis of an axisymmetric
/// body, which strains its rings.
class RigidMotion {
 public:
  /// Bodies are the connected components of the graph of K (nodes that share an entry). `nodes`: d × count.
  RigidMotion(const Points& nodes, const SparseMatrix& stiffness);

  /// `deformation` = displacement less its rigid part.
  void remove(const Vector& displacement, Vector& deformation) const;
  /// Product of a force per dof with that deformation, which is not written anywhere.
  [[nodiscard]] double work(const Vector& force, const Vector& displacement) const;

 private:
  /// The motion is fitted to so many nodes of a body at most: it need not be the very best, as what stays of a rigid
  /// motion is then of the size of the deformation, and a fit to all would cost another pass over all of them.
  static constexpr Index most_fitted = 1024;

  struct Body {
    std::vector<int> fitted;  ///< nodes
    Points positions;         ///< of these, relative to their centre
    Vector position_sum;      ///< Σ of these: zero to rounding
    Vector centre;
    /// Of unit masses there: 1 × 1 in 2D, 3 × 3 in 3D; zero where rotations stay.
    Matrix inverse_inertia;
    bool moves_across = true;  ///< along x; false where that strains
  };
  /// u = translation + rotation × position (in 2D the rotation is its last component).
  struct Motion {
    Eigen::Vector3d translation = Eigen::Vector3d::Zero(), rotation = Eigen::Vector3d::Zero();
  };
  void find_bodies(const Points& nodes, const SparseMatrix& stiffness);
  /// The nodes at which the stiffness has a force on a motion, and no rounding.
  [[nodiscard]] std::vector<char> strained_by(const Vector& motion, const SparseMatrix& stiffness) const;
  [[nodiscard]] std::size_t body_of(std::size_t node) const;
  void keep_rotations_that_strain(const SparseMatrix& stiffness);
  void keep_translations_that_strain(const SparseMatrix& stiffness);
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
  mutable std::vector<Motion> motions_;  ///< per body, of the displacement last seen
};

}  // namespace ricochet
