#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"

/// @file The contact of two bodies: which facets face each other, and the rows of the points between them.
///
/// Multipliers ψ_i live on one surface, s; the other is m. With Π_i the projection of s on m along one constant
/// direction n_i (unit, out of m) and Γ_i the part of the support of ψ_i that hits m,
///   D_i = ∫_Γi ψ_i,   c_ij = (1/D_i) ∫_Γi ψ_i φˢ_j,   m_ik = (1/D_i) ∫_Γi ψ_i φᵐ_k∘Π_i,   Σ_j c_ij = Σ_k m_ik = 1,
///   g_i(U) = n_i · (Σ_j c_ij (X + U)_j − Σ_k m_ik (X + U)_k).
/// The integrals are taken over segments, on which all functions are smooth (SegmentFinder), so that a uniform pressure
/// passes between meshes that do not match; c, m and D_i share their points, so that rows sum to zero to rounding: the
/// pair keeps the linear momentum. With one direction per multiplier the mean gap vector Σ_j c_ij X_j − Σ_k m_ik X_k is
/// along n_i: normal forces have no moment, whatever the shapes.
namespace ricochet {

/// What the conditions of a multiplier are, beside its own trace c.
struct PointConditions {
  Vector normal;                                   ///< unit, out of the obstacle or of the opposite body
  std::vector<std::pair<Index, double>> opposite;  ///< (node k, m_ik); empty at obstacles
  double gap = 0.0;                                ///< g₀
  double gap_rounding = 0.0;
};

/// How two groups face each other, for messages.
struct PairFacing {
  Index points = 0;                  ///< contact points
  Index uncovered = 0;               ///< multipliers that face nothing
  Index held = 0;                    ///< multipliers that supports hold on both sides
  Index lost = 0;                    ///< pieces of facets that are left out, as they are seen edge-on
  double area = 0.0, covered = 0.0;  ///< of the group that carries the multipliers, and of its part that faces
  double partly_covered = 0.0;       ///< of `covered` what lies on facets of which a part faces nothing
  double smallest_gap = std::numeric_limits<double>::infinity(), largest_gap = -smallest_gap;  ///< of points
  Index closed = 0;           ///< points whose gap was below zero and is taken for zero
  double gap_rounding = 0.0;  ///< of the smallest
  double agreement = 1.0;     ///< the shortest mean of the facets' unit normals around a multiplier: 1 where they agree
  Vector edge;                ///< where that is
  bool matches = true;        ///< each node faces a node
};

/// Throws Error(invalid_input) where facets fold so sharply around a node that their normals have no mean.
void refuse_fold(const ContactPair& pair, const PairFacing& facing);

/// The points of one pair of groups, and the nodes on both sides.
struct BodyContact {
  struct Node {
    Index node = 0;
    bool own = true;                                 ///< of the side that carries the multipliers
    Vector normal;                                   ///< unit, towards this node's body
    double gap = 0.0;                                ///< NaN where the node faces nothing
    std::vector<std::pair<Index, double>> opposite;  ///< the shape functions where it faces the other body
  };
  std::vector<Multiplier> multipliers;
  std::vector<PointConditions> conditions;  ///< of each
  std::vector<Node> nodes;                  ///< own ones, then those of the other side, ascending
  /// Pressure on the other side: entries (node, number of the multiplier, value).
  std::vector<Eigen::Triplet<double>> opposite_recovery;
  PairFacing facing;

  /// Leaves out the multipliers, with their conditions, for which `keeps(multiplier, conditions)` is false; returns how
  /// many. Their order stays.
  template <class Keeps>
  Index keep(const Keeps& keeps) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < multipliers.size(); ++i) {
      if (!keeps(std::as_const(multipliers[i]), std::as_const(conditions[i]))) continue;
      if (kept != i) {
        multipliers[kept] = std::move(multipliers[i]);
        conditions[kept] = std::move(conditions[i]);
      }
      ++kept;
    }
    const auto left_out = static_cast<Index>(multipliers.size() - kept);
    multipliers.resize(kept);
    conditions.resize(kept);
    return left_out;
  }
};

/// Finds which facets face each other, and then what the multipliers of a space are there.
class BodyPairing {
 public:
  /// Keeps references. Facets of the pair's group face the other group where some of its facets are seen along their
  /// own mean normal: edges and sides of a body that stands on another one have no part in the contact.
  BodyPairing(const Body& body, const ContactPair& pair);
  ~BodyPairing();
  BodyPairing(const BodyPairing&) = delete;
  BodyPairing& operator=(const BodyPairing&) = delete;

  /// Numbered through all blocks, ascending; may be empty.
  [[nodiscard]] const std::vector<Index>& facing_facets() const;
  /// `space`: on these facets. Throws Error(invalid_input) where facets fold around a multiplier.
  [[nodiscard]] BodyContact make(const MultiplierSpace& space, const FreeComponent& is_free) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
