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
/// Signs, once and for all. The source writes U·N_i ≤ 0 for contact at zero gap, with N_i the normal out of the body,
/// and multipliers ≤ 0. Here:
///   gap operator       G = −B_N: row i is the obstacle's outward normal times multiplier i's weights of the nodes;
///   gap                g = g₀ + G U, ≥ 0 when open;
///   normal reaction    r_N ≥ 0 in compression, a force (per length out of the plane in 2D, of the ring in axisymmetric
///   bodies); force on the body  Gᵀ r_N − B_Tᵀ r_T, with r_T aligned with the slip rate of the body relative to the
///   obstacle.
/// Back to the source: λ̃_N^i = −r_N,i and U·N_i = −(g_i − g₀,i) where the obstacle's normal is −N_i.
namespace ricochet {

/// Friction of a contact pair.
struct FrictionLaw {
  double coefficient = 0.0;  ///< F of Coulomb's law |r_T| ≤ F r_N
  /// A stress, 0: none. With a coefficient the friction is at most min(F r_N, bound × area); without one it is Tresca's
  /// law, |r_T| ≤ bound × area where pressed.
  double bound = 0.0;

  [[nodiscard]] bool any() const { return coefficient > 0.0 || bound > 0.0; }
  friend bool operator==(const FrictionLaw&, const FrictionLaw&) = default;
};

/// One boundary group against one obstacle, or against another group, as a case asks for it.
struct ContactPair {
  std::string group;          ///< that carries the multipliers
  std::vector<Index> facets;  ///< numbered through all blocks
  std::string obstacle_name;  ///< empty: against a group
  const Obstacle* obstacle = nullptr;
  FrictionLaw friction;
  std::string multipliers = "nodal";
  // Against another group:
  std::string opposite_group = {};
  std::vector<Index> opposite_facets = {};
  Vector pair_at = {};           ///< displacement of the group's body at which facets are paired; empty: none
  bool closed_gaps = false;      ///< initial gaps below zero are taken for zero
  bool slides_far = false;       ///< facets are paired anew as the bodies move (sliding/sliding_pair.hpp)
  bool tied = false;             ///< glued (tied_surfaces.hpp): there are no contact points
  bool exchanged = false;        ///< the case names `opposite_group` first: reports give forces on its body
  bool is_one_of_many = false;   ///< of every body against every other: what is far apart is not looked at
  std::string side_reason = {};  ///< why `group` carries the multipliers; empty: the case says which one does

  [[nodiscard]] bool between_bodies() const { return obstacle == nullptr; }
  /// Between bodies, and with contact points.
  [[nodiscard]] bool has_two_sides() const { return between_bodies() && !tied; }
  /// A surface that may touch itself.
  [[nodiscard]] bool is_self() const { return slides_far && facets == opposite_facets; }
  /// The two groups in the order of the case.
  [[nodiscard]] const std::string& first_group() const { return exchanged ? opposite_group : group; }
  [[nodiscard]] const std::string& second_group() const { return exchanged ? group : opposite_group; }
  /// For messages: what a node of the group touches, or between bodies one of the opposite group: obstacle "floor",
  /// group "plate.top".
  [[nodiscard]] std::string opponent(bool of_opposite_group = false) const {
    if (!between_bodies()) return "obstacle \"" + obstacle_name + '"';
    return "group \"" + (of_opposite_group ? group : opposite_group) + '"';
  }
};

/// Whether a node may move along a direction of space: false where a support prescribes that component.
using FreeComponent = std::function<bool(Index node, int component)>;

class ContactSurface;

/// A contact point is a multiplier ψ_i, and carries one normal condition and one normal and tangential reaction. With
/// D_i = ∫ψ_i over the boundary and the trace c_ij = (1/D_i) ∫ψ_i φ_j (Σ_j c_ij = 1), it sees the mean gap
/// g_i = (1/D_i) ∫ψ_i g and its reaction is r_i = D_i λ_i for a multiplier λ in stress units: λ_h = Σ_i (r_i/D_i) ψ_i.
/// The signs of the source's Λ_N^h and the disc of Λ_T^h are conditions on the λ_i. For nodal multipliers c is the
/// identity: each node is a contact point, once per obstacle that may touch it.
///
/// Between two bodies the trace is t = [c, −m] with m_ik of the nodes of the opposite surface (body_contact.hpp), and
/// the rows of G and B_T are t ⊗ n and t ⊗ τ. A reaction acts on both bodies; its sum over them is zero.
///
/// What is here is fixed. Directions and gaps are in `rows`, which `geometry` makes anew where they follow the motion.
struct ContactBoundary {
  int dimension = 2;
  std::vector<Index> facets;  ///< of all pairs, numbered through all blocks, ascending, each once

  // Per contact point:
  std::vector<int> pair;                            ///< index of the ContactPair it came from (the first that names it)
  Vector initial_gap;                               ///< g₀
  Vector weights;                                   ///< D_i > 0: length in 2D, area in 3D and of rings
  Vector friction_coefficient;                      ///< F
  Vector friction_bound;                            ///< a force, bound × D_i; 0: none
  SparseRowMatrix trace;                            ///< t, points × nodes of the space: c, and −m between bodies
  SparseRowMatrix own_trace;                        ///< c: where the point is
  Vector net;                                       ///< Σ_j t_ij: 1 at obstacles, 0 between bodies
  std::shared_ptr<const ContactRows> rows;          ///< at the start: against planes for good
  std::shared_ptr<const ContactGeometry> geometry;  ///< null where rows never change
  /// Between bodies that slide far: 1. Their rows of `trace` are those of c alone: what they see changes with the
  /// motion.
  std::vector<char> slides_far;
  std::vector<Index> reachable_nodes;   ///< of both surfaces of these
  bool touches_itself = false;          ///< some of these have one surface, of which points may be left out
  bool has_friction_elsewhere = false;  ///< at points of other ranks
  double out_of_sight = 0.0;            ///< the gap of such a point where it faces nothing
  std::vector<Index> opposite_node;  ///< per ContactPair, one of the opposite surface of a pair that slides far, or −1

  // Per node of the contact boundary (once per obstacle or pair), for what is reported node by node:
  std::vector<Index> nodes;        ///< ascending; all nodes that the trace of some point, of any rank, reaches
  std::vector<int> node_pair;      ///< index of the (first) ContactPair
  std::vector<char> is_opposite;   ///< 1: of the side of a pair of bodies that carries no multipliers
  std::vector<Index> own_point;    ///< the contact point anchored at the node, or −1; −2: another rank has it
  Points node_normals;             ///< towards the node's body, at the start, d × nodes
  Vector node_initial_gap;         ///< NaN where the node faces nothing
  SparseRowMatrix opposite_place;  ///< contact nodes × nodes: where the node faces another body; 0 × 0 without such
  SparseRowMatrix pressure_recovery;  ///< contact nodes × points: pressure at the nodes = this · r_N, in stress units;
                                      ///< any component of the friction traction likewise from that of the reaction

  /// Areas, for reports (contact_surface.hpp).
  std::shared_ptr<const ContactSurface> surface;

  [[nodiscard]] Index size() const { return initial_gap.size(); }
  [[nodiscard]] bool has_friction() const {
    return has_friction_elsewhere || (friction_coefficient.array() > 0.0).any() || (friction_bound.array() > 0.0).any();
  }
  [[nodiscard]] bool follows_motion() const { return geometry != nullptr; }
  /// Calls visit(node, c_ij) for the nodes that a point sees.
  template <class Visit>
  void visit_nodes(Index point, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator entry(trace, point); entry; ++entry)
      visit(static_cast<Index>(entry.col()), entry.value());
  }
  /// The same for c alone: the nodes whose mean place is that of the point.
  template <class Visit>
  void visit_own_nodes(Index point, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator entry(own_trace, point); entry; ++entry)
      visit(static_cast<Index>(entry.col()), entry.value());
  }
  [[nodiscard]] Index first_own_node(Index point) const {
    return SparseRowMatrix::InnerIterator(own_trace, point).col();
  }
  [[nodiscard]] bool between_bodies(Index point) const { return net[point] == 0.0; }
  [[nodiscard]] bool slides(Index point) const {
    return !slides_far.empty() && slides_far[static_cast<std::size_t>(point)] != 0;
  }
  [[nodiscard]] bool has_sliding_pairs() const { return !reachable_nodes.empty(); }
  /// Calls visit(point, value) for the points that the pressure at an entry of `nodes` comes from.
  template <class Visit>
  void visit_recovery(Index entry, const Visit& visit) const {
    for (SparseRowMatrix::InnerIterator from(pressure_recovery, entry); from; ++from)
      visit(static_cast<Index>(from.col()), from.value());
  }
  /// Pressure at the entries of `nodes`, in stress units; of several ranks what the points of this one add to it.
  void recover_pressure(const Vector& normal_reaction, Vector& pressure) const {
    pressure.noalias() = pressure_recovery * normal_reaction;
  }
  /// Σ_j t_ij X_j with the nodes' positions: the place of a point or, between bodies, the mean vector across the gap.
  /// With it as its arm the force of a point has the moment that it has on all bodies together.
  [[nodiscard]] SpaceVector arm(Index point, const Points& node_positions) const {
    SpaceVector result = SpaceVector::Zero(node_positions.rows());
    for (SparseRowMatrix::InnerIterator entry(trace, point); entry; ++entry)
      result += entry.value() * node_positions.col(entry.col());
    return result;
  }
  /// The nodes that the row of some point may reach, ascending, each once. Points of other ranks may reach more of the
  /// nodes that are here, which are among `nodes`.
  [[nodiscard]] std::vector<Index> unique_nodes() const;
};

}  // namespace ricochet
