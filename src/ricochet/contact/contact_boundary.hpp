#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/contact/contact_geometry.hpp"
#include "ricochet/fem/assembly.hpp"
#include "ricochet/rigid/obstacle.hpp"

/// @file The contact boundary: its multipliers and trace operators.
///
/// Sign conventions. The source writes U·N_i ≤ 0 for contact at zero gap, with N_i the normal out of the body, and
/// multipliers ≤ 0. Here:
///   gap operator       G = −B_N: row i is the obstacle's outward normal times multiplier i's weights of the nodes;
///   gap                g = g₀ + G U, ≥ 0 if open;
///   normal reaction    r_N ≥ 0 in compression, a force (per unit thickness in 2D, of the whole ring in axisymmetric
///                      bodies); the force on the body is Gᵀ r_N − B_Tᵀ r_T, with r_T aligned with the slip rate of the
///                      body relative to the obstacle.
/// Conversion to the source: λ̃_N^i = −r_N,i and U·N_i = −(g_i − g₀,i), where the obstacle's normal is −N_i.
namespace ricochet {

/// Friction of a contact pair.
struct FrictionLaw {
  double coefficient = 0.0;  ///< F of Coulomb's law |r_T| ≤ F r_N
  /// A stress, 0 if none. With a coefficient the friction is at most min(F r_N, bound × area); without one it is
  /// Tresca's law, |r_T| ≤ bound × area in contact.
  double bound = 0.0;

  [[nodiscard]] bool any() const { return coefficient > 0.0 || bound > 0.0; }
  friend bool operator==(const FrictionLaw&, const FrictionLaw&) = default;
};

/// Names of two groups in contact, for messages: "a" and "b", or "a" and itself.
[[nodiscard]] inline std::string pair_names(const std::string& group, const std::string& opponent) {
  return '"' + group + "\" and " + (group == opponent ? "itself" : '"' + opponent + '"');
}

/// Boundary group in contact with an obstacle, or with another group, as specified by a case.
struct ContactPair {
  std::string group;          ///< with the multipliers
  std::vector<Index> facets;  ///< numbered through all blocks
  std::string obstacle_name;  ///< empty for contact with a group
  const Obstacle* obstacle = nullptr;
  FrictionLaw friction;
  std::string multipliers = "nodal";
  // For contact with another group:
  std::string opposite_group = {};
  std::vector<Index> opposite_facets = {};
  Vector pair_at = {};           ///< displacement of the group's body at which facets are paired; empty if none
  bool closed_gaps = false;      ///< whether negative initial gaps count as zero
  bool large_sliding = false;    ///< whether facets are paired anew as the bodies move (sliding/sliding_pair.hpp)
  bool tied = false;             ///< whether the groups are glued (tied_surfaces.hpp); there are no contact points then
  bool exchanged = false;        ///< whether the case names `opposite_group` first; reports give forces on its body
  bool is_one_of_many = false;   ///< whether it is one of all pairs of bodies; surfaces far apart are then skipped
  bool at_corners = false;       ///< whether the pair consists of the corners of another one (mortar/corner_pairs.hpp)
  std::string side_reason = {};  ///< why `group` carries the multipliers; empty if the case specifies it

  [[nodiscard]] bool between_bodies() const { return obstacle == nullptr; }
  /// Whether the pair is between bodies and has contact points.
  [[nodiscard]] bool has_two_sides() const { return between_bodies() && !tied; }
  /// Gives the multipliers to the other side.
  void exchange_sides() {
    std::swap(group, opposite_group);
    std::swap(facets, opposite_facets);
    if (pair_at.size() > 0) pair_at = -pair_at;
    exchanged = !exchanged;
  }
  /// Whether the surface may come into contact with itself.
  [[nodiscard]] bool is_self() const { return large_sliding && facets == opposite_facets; }
  /// The two groups in the order of the case.
  [[nodiscard]] const std::string& first_group() const { return exchanged ? opposite_group : group; }
  [[nodiscard]] const std::string& second_group() const { return exchanged ? group : opposite_group; }
  /// Name, for messages, of the counterpart of a node of the group (or, between bodies, of the opposite group):
  /// obstacle "floor", group "plate.top".
  [[nodiscard]] std::string opponent(bool of_opposite_group = false) const {
    if (!between_bodies()) return "obstacle \"" + obstacle_name + '"';
    return "group \"" + (of_opposite_group ? group : opposite_group) + '"';
  }
};

/// Returns whether a node may move along a component; false if a support prescribes it.
using FreeComponent = std::function<bool(Index node, int component)>;

class ContactSurface;

/// A contact point is a multiplier ψ_i, with one normal condition and one normal and tangential reaction. With
/// D_i = ∫ψ_i over the boundary and the trace c_ij = (1/D_i) ∫ψ_i φ_j (Σ_j c_ij = 1), its gap is the mean
/// g_i = (1/D_i) ∫ψ_i g and its reaction is r_i = D_i λ_i for a multiplier λ in stress units: λ_h = Σ_i (r_i/D_i) ψ_i.
/// The signs of the source's Λ_N^h and the disc of Λ_T^h are conditions on the λ_i. For nodal multipliers c is the
/// identity: each node is a contact point, once per obstacle with which it may come into contact.
///
/// Between two bodies the trace is t = [c, −m] with m_ik on the nodes of the opposite surface (body_contact.hpp), and
/// the rows of G and B_T are t ⊗ n and t ⊗ τ. A reaction acts on both bodies; its sum over them is zero.
///
/// The members are constant. Directions and gaps are in `rows`, which `geometry` updates if they follow the motion.
struct ContactBoundary {
  int dimension = 2;
  std::vector<Index> facets;  ///< of all pairs, numbered through all blocks, ascending and unique

  // Per contact point:
  std::vector<int> pair;                            ///< index of its ContactPair (the first that contains it)
  Vector initial_gap;                               ///< g₀
  Vector weights;                                   ///< D_i > 0: length in 2D, area in 3D and of rings
  Vector friction_coefficient;                      ///< F
  Vector friction_bound;                            ///< a force, bound × D_i; 0 if none
  std::vector<char> rows_follow;                    ///< 1 if its rows follow the motion
  SparseRowMatrix trace;                            ///< t, points × nodes of the space: c, and −m between bodies
  SparseRowMatrix own_trace;                        ///< c, the weights of a point's mean position
  Vector net;                                       ///< Σ_j t_ij: 1 at obstacles, 0 between bodies
  std::shared_ptr<const ContactRows> rows;          ///< at the start; constant if all obstacles are planes
  std::shared_ptr<const ContactGeometry> geometry;  ///< null if rows never change
  /// Between bodies that slide far: 1. For these `trace` contains c alone: the opposite nodes change with the motion.
  std::vector<char> large_sliding;
  std::vector<Index> reachable_nodes;   ///< of both surfaces of these pairs
  bool touches_itself = false;          ///< whether one of them is a single surface, whose points may be deactivated
  bool has_friction_elsewhere = false;  ///< whether points of other ranks have friction
  double unpaired_gap = 0.0;            ///< the gap of such a point if it faces nothing
  std::vector<Index> opposite_node;     ///< per ContactPair: a node of the opposite surface if it slides far, or −1

  // Per node of the contact boundary (once per obstacle or pair), for nodal output:
  std::vector<Index> nodes;       ///< ascending; all nodes in the trace of some point, of any rank
  std::vector<int> node_pair;     ///< index of the (first) ContactPair
  std::vector<char> is_opposite;  ///< 1 on the side of a pair of bodies without multipliers
  std::vector<Index> own_point;   ///< the contact point anchored at the node; −1 if none, −2 if on another rank
  Points node_normals;            ///< towards the node's body, at the start, d × nodes
  Vector node_initial_gap;        ///< NaN if the node faces nothing
  SparseRowMatrix
      opposite_projection;  ///< contact nodes × nodes: projections onto other bodies; 0 × 0 if there are none
  SparseRowMatrix pressure_recovery;  ///< contact nodes × points: pressure at the nodes = this · r_N, in stress units;
                                      ///< any component of the friction traction likewise from that of the reaction

  /// Areas, for output (contact_surface.hpp).
  std::shared_ptr<const ContactSurface> surface;

  [[nodiscard]] Index size() const { return initial_gap.size(); }
  [[nodiscard]] bool has_friction() const {
    return has_friction_elsewhere || (friction_coefficient.array() > 0.0).any() || (friction_bound.array() > 0.0).any();
  }
  [[nodiscard]] bool has_friction(Index point) const {
    return friction_coefficient[point] > 0.0 || friction_bound[point] > 0.0;
  }
  [[nodiscard]] bool follows_motion() const { return geometry != nullptr; }
  /// Holds the present pairs of facets until the end of the step. Returns false if there are none, or if they are held.
  [[nodiscard]] bool freeze_pairs() const { return follows_motion() && geometry->freeze(); }
  [[nodiscard]] bool follows_motion(Index point) const {
    return !rows_follow.empty() && rows_follow[std::size_t(point)] != 0;
  }
  /// Calls visit(node, t_ij) for the nodes in the trace of a point.
  template <class Visit>
  void visit_nodes(Index point, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator entry(trace, point); entry; ++entry) visit(Index(entry.col()), entry.value());
  }
  /// Calls visit(node, c_ij) for c alone: the nodes whose mean position is that of the point.
  template <class Visit>
  void visit_own_nodes(Index point, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator entry(own_trace, point); entry; ++entry)
      visit(Index(entry.col()), entry.value());
  }
  [[nodiscard]] Index first_own_node(Index point) const {
    return SparseRowMatrix::InnerIterator(own_trace, point).col();
  }
  [[nodiscard]] bool between_bodies(Index point) const { return net[point] == 0.0; }
  [[nodiscard]] bool slides(Index point) const {
    return !large_sliding.empty() && large_sliding[std::size_t(point)] != 0;
  }
  [[nodiscard]] bool has_sliding_pairs() const { return !reachable_nodes.empty(); }
  /// Calls visit(point, value) for the points from which the pressure at an entry of `nodes` is recovered.
  template <class Visit>
  void visit_recovery(Index entry, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator from(pressure_recovery, entry); from; ++from)
      visit(Index(from.col()), from.value());
  }
  /// Computes the pressure at the entries of `nodes`, in stress units; with several ranks, the
  /// contribution of the local points.
  void recover_pressure(const Vector& normal_reaction, Vector& pressure) const {
    pressure.noalias() = pressure_recovery * normal_reaction;
  }
  /// Σ_j t_ij X_j with the positions of the nodes: the position of a point or, between bodies, the mean vector across
  /// the gap. As the arm of a point's force, it yields the moment of that force on all bodies together.
  [[nodiscard]] SpaceVector arm(Index point, const Points& node_positions) const {
    SpaceVector result = SpaceVector::Zero(node_positions.rows());
    for (SparseRowMatrix::InnerIterator entry(trace, point); entry; ++entry)
      result += entry.value() * node_positions.col(entry.col());
    return result;
  }
  /// Nodes that the row of some point may involve, ascending and unique. Points of other ranks may involve more of the
  /// local nodes, which are in `nodes`.
  [[nodiscard]] std::vector<Index> unique_nodes() const;
};

}  // namespace ricochet
