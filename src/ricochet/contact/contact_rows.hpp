#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/space_vector.hpp"

/// @file Conditions of the contact points, linear in the displacement. Against planes they hold for a whole run; for a
/// curved surface they are those at one displacement and time.
namespace ricochet {

/// Data of contact rows that do not depend on the frame in which their columns are (corotated_frame.hpp).
struct ContactFrames {
  Points normals;                ///< unit normal out of the obstacle, d × points
  std::vector<Points> tangents;  ///< d × (d−1), orthonormal with the normal
  std::vector<char> slips;       ///< per row of B_T; 0 if supports constrain that direction: no friction
  Vector gap_rounding;           ///< up to which a gap is zero to rounding
  Vector gap;                    ///< at the last update, if rows may change
  /// For contact between bodies that slide far, whose rows involve other nodes as the bodies move: the displacements
  /// from which the rows were computed. Empty if rows have the same pattern for the whole run.
  Vector sliding_state;
};

/// Row i of the gap operator G = c ⊗ nᵀ and rows (d−1)i … of B_T = c ⊗ tᵀ are the derivatives of point i's gap and of
/// its displacements along the surface. Contact solvers read the matrices; other code uses the functions.
struct ContactRows : ContactFrames {
  SparseRowMatrix gap_operator;      ///< G, points × dofs
  SparseRowMatrix tangential_trace;  ///< B_T, (d−1)·points × dofs; a row without slip is zero
  std::vector<long> revision;        ///< per point: changes with its row; empty if rows never change

  [[nodiscard]] Index size() const { return normals.cols(); }
  [[nodiscard]] int dimension() const { return int(normals.rows()); }
  [[nodiscard]] SpaceVector normal(Index point) const { return normals.col(point); }
  /// Vector with given components along the tangents of a point, (d−1) per point.
  [[nodiscard]] SpaceVector along_tangents(Index point, const Vector& components) const;
  /// Force of a point on the body: r_N n − t r_T. `tangential` may be empty.
  [[nodiscard]] SpaceVector force(Index point, const Vector& normal, const Vector& tangential) const;
  /// Adds Gᵀ r_N − B_Tᵀ r_T to a force vector. `tangential` may be empty (frictionless).
  void add_force(const Vector& normal, const Vector& tangential, Vector& force) const;
  /// Compute G v and B_T v for velocities or displacements.
  void normal_motion(const Vector& values, Vector& result) const { result.noalias() = gap_operator * values; }
  void tangential_motion(const Vector& values, Vector& result) const { result.noalias() = tangential_trace * values; }
  /// Calls visit(dof, value) for the entries of a row of G or B_T.
  template <class Visit>
  void visit_normal(Index point, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator entry(gap_operator, point); entry; ++entry)
      visit(Index(entry.col()), entry.value());
  }
  template <class Visit>
  void visit_tangential(Index row, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator entry(tangential_trace, row); entry; ++entry)
      visit(Index(entry.col()), entry.value());
  }
};

/// Motion of the obstacles at the contact points: velocities, or increments over a step.
/// All empty if no obstacle moves.
struct ObstacleMotion {
  Vector normal;      ///< n·v, per point
  Vector tangential;  ///< tᵀv, (d−1) per point; 0 for zero rows of B_T
  Points in_space;    ///< v, d × points, if rows follow the motion and may be replaced; else empty
};

/// Projects a motion of the obstacles onto the directions of these rows.
void project_motion(const ContactRows& rows, ObstacleMotion& motion);

/// Compute G v and B_T v relative to the motion of the obstacles: changes of gaps, and slips.
void motion_from_obstacles(const ContactRows& rows, const Vector& values, const ObstacleMotion& motion,
                           Vector& gap_change);
void slip_on_obstacles(const ContactRows& rows, const Vector& values, const ObstacleMotion& motion, Vector& slip);

}  // namespace ricochet
