#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/contact/contact_stress.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"
#include "ricochet/problem/damping.hpp"
#include "ricochet/problem/follower_pressure.hpp"
#include "ricochet/problem/internal_force.hpp"
#include "ricochet/problem/loads.hpp"

/// @file The semi-discrete problem, eq. (2) of the source:
///   M Ü + C U̇ + K U = L + Gᵀ r_N − B_Tᵀ r_T  (+ support reactions),   0 ≤ r_N ⟂ g₀ + G U ≥ 0,
///   |r_T,i| ≤ F_i r_N,i,   r_T,i = F_i r_N,i w_i/|w_i| where the slip rate w = B_T U̇ − (the obstacle's) is not zero.
/// Where an obstacle translates by s(t), the gap is g₀ + G U − n·s(t). Between two bodies G and B_T have the difference
/// of their displacements, and so reactions act on both.
namespace ricochet {

struct SemidiscreteProblem {
  int dimension = 2;
  /// Of a section through bodies that are the same all round the axis x = 0: their only rigid motion is the translation
  /// along it, and forces, momenta and impulses across it cancel over the ring.
  bool axisymmetric = false;
  Points nodes;     ///< reference positions, d × nodes
  NodeMatrix mass;  ///< M, or M₀ of an equivalent mass
  Damping damping;
  std::shared_ptr<const InternalForce> internal_force;
  Loads loads;
  /// Loads that follow the surface, where the internal force is not linear; null: none. The varying load of a step
  /// contains them.
  std::shared_ptr<const FollowerPressure> pressure;
  Supports supports;
  ContactBoundary contact;
  /// Nodes that follow others: their rows of all matrices and loads are zero, and no stage solves for them. Null: none.
  const TiedNodes* tied = nullptr;
  std::vector<const Obstacle*> obstacles;  ///< of each contact pair; null between bodies
  /// Rigid bodies that move by the forces on them. Two nodes each, the last ones (free_motion.hpp).
  std::vector<std::shared_ptr<FreeMotion>> free_bodies;
  /// Makes the stress at the contact points, for the schemes that need it.
  std::function<ContactStress()> contact_stress;
  const Ranks* ranks = &one_rank();  ///< that the body is divided among; never null

  /// Dofs without inertia: those of the contact nodes when the mass is an equivalent one, else none. Ascending.
  std::vector<Index> massless_dofs;
  std::vector<char> is_massless;                                       ///< per dof
  bool has_massless_elsewhere = false, has_contact_elsewhere = false;  ///< such dofs, on other ranks
  /// Dofs of the contact nodes that no support holds, ascending.
  std::vector<Index> contact_dofs;

  [[nodiscard]] Index dof_count() const { return nodes.cols() * dimension; }
  [[nodiscard]] bool is_tied_dof(Index dof) const { return tied != nullptr && tied->is_tied(dof / dimension); }
  /// Nodes of cells; those of rigid bodies that move freely come after them.
  [[nodiscard]] Index cell_node_count() const { return nodes.cols() - 2 * static_cast<Index>(free_bodies.size()); }
  [[nodiscard]] bool is_of_free_body(Index node) const { return node >= cell_node_count(); }
  /// The second of its nodes: its displacements, velocities and forces are no vectors of space.
  [[nodiscard]] bool is_rotation_node(Index node) const {
    return is_of_free_body(node) && (nodes.cols() - node) % 2 == 1;
  }
  [[nodiscard]] bool has_damping() const { return !damping.is_absent(); }
  [[nodiscard]] bool has_singular_mass() const { return has_massless_elsewhere || !massless_dofs.empty(); }
  /// Of all ranks, which ask together.
  [[nodiscard]] bool has_diagonal_mass() const { return !ranks->any(!mass.is_diagonal()); }
  [[nodiscard]] Index all_contact_points() const {
    return static_cast<Index>(ranks->sum(static_cast<double>(contact.size())));
  }
  [[nodiscard]] bool has_contact_dofs() const { return has_contact_elsewhere || !contact_dofs.empty(); }
  /// What values per dof are on contact_dofs, and the other way. (Eigen's indexed views copy their indices.)
  void take_contact(const Vector& values, Eigen::Ref<Vector> on_contact) const;
  void put_contact(const Eigen::Ref<const Vector>& on_contact, Vector& values) const;
  /// Of the cells at contact_dofs alone, right at the nodes of these; null where there are none.
  [[nodiscard]] std::shared_ptr<const InternalForce> force_near_contact() const;
  /// Null between bodies.
  [[nodiscard]] const Obstacle* obstacle_of_point(Index point) const {
    return obstacles[static_cast<std::size_t>(contact.pair[static_cast<std::size_t>(point)])];
  }
  [[nodiscard]] bool has_moving_obstacles() const;
  /// Gaps of all contact points at a displacement and a time.
  void gaps(const Vector& displacement, double time, Vector& gap) const;
  /// Gaps of the nodes of the contact boundary likewise.
  void node_gaps(const Vector& displacement, double time, Vector& gap) const;
  /// The normal at a node of the contact boundary.
  [[nodiscard]] SpaceVector node_normal(Index entry, const Vector& displacement, double time) const;
  /// Returns whether some of them turn or spin: their velocity depends on the position of the contact points.
  [[nodiscard]] bool has_turning_obstacles() const;
  /// Velocities of the obstacles where the contact points are at this displacement and time, along the directions of
  /// the rows at the start: their means over a span of time with this one in its middle, or for 0 at the time.
  void obstacle_velocity(const Vector& displacement, double time, double span, ObstacleMotion& velocity) const;
  /// Size of the rounding errors of a trace c·v, per point: 8 ε Σ_j |c_ij| |v_j|, a few roundings of v and of the
  /// products.
  void trace_rounding(const Vector& values, Vector& rounding) const;

 private:
  [[nodiscard]] SpaceVector position(Index point, const Vector& displacement) const;
};

/// Dofs of the nodes that contact points reach, supported ones too, ascending; of several ranks, points of this one.
[[nodiscard]] std::vector<Index> contact_node_dofs(const SemidiscreteProblem& problem);

/// Fills massless_dofs, is_massless and contact_dofs from contact and supports, and takes the mass: dofs × dofs,
/// symmetric to the bit.
void finish_problem(SemidiscreteProblem& problem, const SparseMatrix& mass, bool mass_without_contact_inertia);

}  // namespace ricochet
