#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"

/// @file Contact of two bodies: the pairing of their facets, and the rows of the points between them.
///
/// Multipliers ψ_i live on one surface, s; the other is m. With Π_i the projection of s on m along one constant
/// direction n_i (unit, out of m) and Γ_i the part of the support of ψ_i whose projection hits m,
///   D_i = ∫_Γi ψ_i,   c_ij = (1/D_i) ∫_Γi ψ_i φˢ_j,   m_ik = (1/D_i) ∫_Γi ψ_i φᵐ_k∘Π_i,   Σ_j c_ij = Σ_k m_ik = 1,
///   g_i(U) = n_i · (Σ_j c_ij (X + U)_j − Σ_k m_ik (X + U)_k).
/// The integrals are taken over segments, on which all functions are smooth (SegmentFinder), so that a uniform pressure
/// is transmitted between non-matching meshes; c, m and D_i share their quadrature points, so that rows sum to zero to
/// rounding: the pair conserves linear momentum. With one direction per multiplier the mean gap vector Σ_j c_ij X_j −
/// Σ_k m_ik X_k is along n_i: normal forces have no moment, whatever the shapes.
namespace ricochet {

/// Conditions of a multiplier in addition to its own trace c.
struct PointConditions {
  Vector normal;                                   ///< unit, out of the obstacle or of the opposite body
  std::vector<std::pair<Index, double>> opposite;  ///< (node k, m_ik); empty at obstacles
  double gap = 0.0;                                ///< g₀
  double gap_rounding = 0.0;
};

/// Statistics of the pairing of two groups, for messages.
struct PairingSummary {
  Index points = 0;                  ///< number of contact points
  Index uncovered = 0;               ///< number of multipliers that face nothing
  Index held = 0;                    ///< number of multipliers constrained by supports on both sides
  Index lost = 0;                    ///< number of pieces of facets omitted because they are seen edge-on
  double area = 0.0, covered = 0.0;  ///< of the group with the multipliers, and of its part that faces the other
  double partly_covered = 0.0;       ///< the part of `covered` on facets that are covered incompletely
  double smallest_gap = std::numeric_limits<double>::infinity(), largest_gap = -smallest_gap;  ///< over all points
  Index closed = 0;           ///< number of points whose gap was negative and is set to zero
  double gap_rounding = 0.0;  ///< of the smallest gap
  double agreement = 1.0;     ///< smallest |mean of the facets' unit normals| around a multiplier: 1 if they agree
  Vector edge;                ///< location of that minimum
  bool matches = true;        ///< whether each node faces a node
};

/// Throws Error(invalid_input) if facets fold so sharply around a node that their normals have no mean.
void refuse_fold(const ContactPair& pair, const PairingSummary& facing);

/// Contact points of one pair of groups, and the nodes on both sides.
struct BodyContact {
  struct Node {
    Index node = 0;
    bool own = true;                                 ///< whether on the side that carries the multipliers
    Vector normal;                                   ///< unit, towards this node's body
    double gap = 0.0;                                ///< NaN if the node faces nothing
    std::vector<std::pair<Index, double>> opposite;  ///< shape functions at its projection onto the other body
  };
  std::vector<Multiplier> multipliers;
  std::vector<PointConditions> conditions;  ///< per multiplier
  std::vector<Node> nodes;                  ///< nodes of the own side, then those of the other side, ascending
  /// Pressure recovery on the other side: entries (node, number of the multiplier, value).
  std::vector<Eigen::Triplet<double>> opposite_recovery;
  PairingSummary facing;

  /// Removes the multipliers, with their conditions, for which `keeps(multiplier, conditions)` is false; returns their
  /// number. The order is preserved.
  template <class Keeps>
  Index keep(const Keeps& keeps) {
    std::size_t retained = 0;
    for (std::size_t i = 0; i < multipliers.size(); ++i) {
      if (!keeps(std::as_const(multipliers[i]), std::as_const(conditions[i]))) continue;
      if (retained != i) {
        multipliers[retained] = std::move(multipliers[i]);
        conditions[retained] = std::move(conditions[i]);
      }
      ++retained;
    }
    const auto left_out = Index(multipliers.size() - retained);
    multipliers.resize(retained);
    conditions.resize(retained);
    return left_out;
  }
};

/// Finds the facets that face each other, and then the multipliers of a space on them.
class BodyPairing {
 public:
  /// Keeps references. Facets of the pair's group face the other group if some of its facets are hit along their own
  /// mean normal: this excludes edges and lateral faces of a body that stands on another one.
  BodyPairing(const Body& body, const ContactPair& pair);
  ~BodyPairing();
  BodyPairing(const BodyPairing&) = delete;
  BodyPairing& operator=(const BodyPairing&) = delete;

  /// Facing facets, numbered through all blocks, ascending; may be empty.
  [[nodiscard]] const std::vector<Index>& facing_facets() const;
  /// Builds the contact; `space`: on these facets. Throws Error(invalid_input) if facets fold around a multiplier.
  [[nodiscard]] BodyContact make(const MultiplierSpace& space, const FreeComponent& is_free) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
