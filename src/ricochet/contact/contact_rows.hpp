#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/space_vector.hpp"

/// @file The conditions of the contact points, linear in the displacement. Against planes they hold for a whole run;
/// where a surface is curved they are those at one displacement and time.
namespace ricochet {

/// Row i of the gap operator G = c ⊗ nᵀ and rows (d−1)i … of B_T = c ⊗ tᵀ are the derivatives of point i's gap and of
/// its displacements along the surface. Contact solvers read the matrices; all others ask the functions.
struct ContactRows {
  Points normals;                    ///< unit normal out of the obstacle, d × points
  std::vector<Points> tangents;      ///< d × (d−1), orthonormal with the normal
  std::vector<char> slips;           ///< per row of B_T; 0: supports hold the body in that direction, no friction acts
  Vector gap_rounding;               ///< a gap up to this is zero to rounding
  SparseRowMatrix gap_operator;      ///< G, points × dofs
  SparseRowMatrix tangential_trace;  ///< B_T, (d−1)·points × dofs; a row is zero where nothing slips
  Vector gap;                        ///< where rows may change: at the last look
  std::vector<long> revision;        ///< per point: another number, another row; empty where rows never change
  /// Of contact between bodies that slide far, where rows reach other nodes as the bodies go: from which places they
  /// were made. Empty: rows have the same entries for the whole run.
  Vector places;
  /// c, points × nodes, of points whose rows have the entries c ⊗ n and c ⊗ t, those alone and whatever their
  /// directions are; the rows of all others are empty. Null: no point has directions that turn.
  std::shared_ptr<const SparseRowMatrix> turning_trace;

  [[nodiscard]] Index size() const { return normals.cols(); }
  [[nodiscard]] int dimension() const { return static_cast<int>(normals.rows()); }
  [[nodiscard]] SpaceVector normal(Index point) const { return normals.col(point); }
  /// Of components along the tangents of a point, (d−1) per point, the vector in space.
  [[nodiscard]] SpaceVector along_tangents(Index point, const Vector& components) const;
  /// The force of a point on the body: r_N n − t r_T. `tangential` may be empty.
  [[nodiscard]] SpaceVector force(Index point, const Vector& normal, const Vector& tangential) const;
  /// Adds Gᵀ r_N − B_Tᵀ r_T to a force vector. `tangential` may be empty (frictionless).
  void add_force(const Vector& normal, const Vector& tangential, Vector& force) const;
  /// G v and B_T v: of velocities or of displacements.
  void normal_motion(const Vector& values, Vector& result) const { result.noalias() = gap_operator * values; }
  void tangential_motion(const Vector& values, Vector& result) const { result.noalias() = tangential_trace * values; }
  /// Calls visit(dof, value) for the entries of a row of G or B_T.
  template <class Visit>
  void visit_normal(Index point, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator entry(gap_operator, point); entry; ++entry)
      visit(static_cast<Index>(entry.col()), entry.value());
  }
  template <class Visit>
  void visit_tangential(Index row, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator entry(tangential_trace, row); entry; ++entry)
      visit(static_cast<Index>(entry.col()), entry.value());
  }
};

/// What obstacles do at the contact points: velocities, or increments over a step. All empty when no obstacle moves.
struct ObstacleMotion {
  Vector normal;      ///< n·v, per point
  Vector tangential;  ///< tᵀv, (d−1) per point; 0 along rows of B_T that are zero
  Points in_space;    ///< v, d × points, where rows follow the motion: others may be asked for; else empty
};

/// Components of a motion of the obstacles along the directions of these rows.
void project_motion(const ContactRows& rows, ObstacleMotion& motion);

/// G v and B_T v less what the obstacles do: changes of gaps, and slips.
void motion_from_obstacles(const ContactRows& rows, const Vector& values, const ObstacleMotion& motion,
                           Vector& gap_change);
void slip_on_obstacles(const ContactRows& rows, const Vector& values, const ObstacleMotion& motion, Vector& slip);

}  // namespace ricochet
