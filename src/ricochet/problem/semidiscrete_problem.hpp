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

/// @file Semi-discrete problem, eq. (2) of the source:
///   M Ü + C U̇ + K U = L + Gᵀ r_N − B_Tᵀ r_T  (+ support reactions),   0 ≤ r_N ⟂ g₀ + G U ≥ 0,
///   |r_T,i| ≤ F_i r_N,i,   r_T,i = F_i r_N,i w_i/|w_i| if the slip rate w = B_T U̇ − (the obstacle's) is not zero.
/// If an obstacle translates by s(t), the gap is g₀ + G U − n·s(t). Between two bodies G and B_T apply to the
/// difference of their displacements, so that reactions act on both.
namespace ricochet {

struct SemidiscreteProblem {
  int dimension = 2;
  /// Whether the mesh is the meridian section of bodies of revolution about the axis x = 0: their only rigid motion is
  /// the translation along it, and forces, momenta and impulses across it cancel over the ring.
  bool axisymmetric = false;
  Points nodes;     ///< reference positions, d × nodes
  NodeMatrix mass;  ///< M, or M₀ of an equivalent mass
  Damping damping;
  std::shared_ptr<const InternalForce> internal_force;
  Loads loads;
  /// Loads that follow the surface, if the internal force is not linear; null if none. They are part
  /// of the varying load of a step.
  std::shared_ptr<const FollowerPressure> pressure;
  Supports supports;
  ContactBoundary contact;
  /// Tied nodes: their rows of all matrices and loads are zero, and no stage solves for them. Null if none.
  const TiedNodes* tied = nullptr;
  std::vector<const Obstacle*> obstacles;  ///< per contact pair; null between bodies
  /// Rigid bodies that move under the forces on them; the last nodes are theirs, two each (free_motion.hpp).
  std::vector<std::shared_ptr<FreeMotion>> free_bodies;
  /// Creates the stress at the contact points, for the schemes that require it.
  std::function<ContactStress()> contact_stress;
  const Ranks* ranks = &one_rank();  ///< among which the body is partitioned; never null

  /// Dofs without inertia: those of the contact nodes if the mass is an equivalent one, else none. Ascending.
  std::vector<Index> massless_dofs;
  std::vector<char> is_massless;                                       ///< per dof
  bool has_massless_elsewhere = false, has_contact_elsewhere = false;  ///< whether other ranks have such dofs
  /// Unsupported dofs of the contact nodes, ascending.
  std::vector<Index> contact_dofs;

  [[nodiscard]] Index dof_count() const { return nodes.cols() * dimension; }
  [[nodiscard]] bool is_tied_dof(Index dof) const { return tied != nullptr && tied->is_tied(dof / dimension); }
  /// Number of nodes of cells; those of free rigid bodies follow.
  [[nodiscard]] Index cell_node_count() const { return nodes.cols() - 2 * Index(free_bodies.size()); }
  [[nodiscard]] bool is_of_free_body(Index node) const { return node >= cell_node_count(); }
  /// Whether the node is the second of a rigid body: its displacement, velocity and force are not spatial vectors.
  [[nodiscard]] bool is_rotation_node(Index node) const {
    return is_of_free_body(node) && (nodes.cols() - node) % 2 == 1;
  }
  [[nodiscard]] bool has_damping() const { return !damping.is_absent(); }
  [[nodiscard]] bool has_singular_mass() const { return has_massless_elsewhere || !massless_dofs.empty(); }
  /// Global properties, of all ranks; collective calls.
  [[nodiscard]] bool has_diagonal_mass() const { return !ranks->any(!mass.is_diagonal()); }
  [[nodiscard]] Index global_contact_point_count() const { return Index(ranks->sum(double(contact.size()))); }
  [[nodiscard]] bool has_contact_dofs() const { return has_contact_elsewhere || !contact_dofs.empty(); }
  /// Gather values per dof at contact_dofs, and scatter them back. (Eigen's indexed views copy their indices.)
  void gather_contact(const Vector& values, Eigen::Ref<Vector> on_contact) const;
  void scatter_contact(const Eigen::Ref<const Vector>& on_contact, Vector& values) const;
  /// Returns the internal force of the cells at contact_dofs alone, exact at the nodes of these
  /// dofs; null if there are none.
  [[nodiscard]] std::shared_ptr<const InternalForce> internal_force_at_contact() const;
  /// Obstacle of a contact point; null between bodies.
  [[nodiscard]] const Obstacle* obstacle_of_point(Index point) const {
    return obstacles[std::size_t(contact.pair[std::size_t(point)])];
  }
  [[nodiscard]] bool has_moving_obstacles() const;
  /// Computes the gaps of all contact points at a displacement and a time.
  void gaps(const Vector& displacement, double time, Vector& gap) const;
  /// Computes the gaps of the nodes of the contact boundary at a displacement and a time.
  void node_gaps(const Vector& displacement, double time, Vector& gap) const;
  /// Normal at a node of the contact boundary.
  [[nodiscard]] SpaceVector node_normal(Index entry, const Vector& displacement, double time) const;
  /// Whether an obstacle rotates or spins, so that its velocity depends on the position of the contact points.
  [[nodiscard]] bool has_rotating_obstacles() const;
  /// Computes the obstacle velocities at the contact points of this displacement and time, along the directions of the
  /// initial rows: means over a time span centred at `time`, or instantaneous values for a span of 0.
  void obstacle_velocity(const Vector& displacement, double time, double span, ObstacleMotion& velocity) const;
  /// Computes the rounding error of a trace c·v per point: 8 ε Σ_j |c_ij| |v_j|, a few
  /// roundings of v and of the products.
  void trace_rounding(const Vector& values, Vector& rounding) const;

 private:
  [[nodiscard]] SpaceVector position(Index point, const Vector& displacement) const;
};

/// Dofs of the nodes of the contact points, supported ones included, ascending; with
/// several ranks, of the local points.
[[nodiscard]] std::vector<Index> contact_node_dofs(const SemidiscreteProblem& problem);

/// Fills massless_dofs, is_massless and contact_dofs from contact and supports, and stores the mass:
/// dofs × dofs, exactly symmetric.
void finish_problem(SemidiscreteProblem& problem, const SparseMatrix& mass, bool mass_without_contact_inertia);

}  // namespace ricochet
