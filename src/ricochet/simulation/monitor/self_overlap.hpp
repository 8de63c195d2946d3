#pragma once

#include <optional>

#include "ricochet/simulation/monitor/body_surface.hpp"

/// @file Nodes of a body's surface that have gone through the surface of the same body.
///
/// A ray from a node out of the body meets the outside of another part of the surface first, or nothing. Where it meets
/// the inside of one first, the node lies inside of that part. The depth is the distance to the surface that it has
/// come through: the closest piece that faces the node's own surface and has the node behind it, or, where that is
/// less, the way on along a ray. Rays that meet both sides at one place graze an edge and decide nothing, and neither
/// does a node whose pieces have no common outside. All of the up to three rays that lead out of the node's own pieces
/// must agree, so that the rounding of one of them finds nothing.
namespace ricochet {

/// Allocates nothing.
class SelfOverlap {
 public:
  struct Found {
    double depth = 0.0;
    int own_piece = -1;    ///< of the pieces around the node, that which faces the other one most
    int other_piece = -1;  ///< that it has come through
  };

  /// `mirrored`: the surface is the half of a section beyond the axis x = 0, whose other half is its image; without the
  /// pieces on the axis. Keeps a reference.
  SelfOverlap(const BodySurface& surface, bool mirrored) : surface_(surface), mirrored_(mirrored) {}

  /// The least cosine between the normal at a node and those of the pieces around it: small at notches and at edges of
  /// knives, where a normal says little of what is outside. A notch that closes beyond itself looks like an edge.
  [[nodiscard]] double opening(int node) const;
  /// Looks at a node, by its number on the surface, where the surface is now; nothing: it is in no other part.
  /// `clearance`: how far from the node along its normal the outside of another part is; infinite: it sees none.
  [[nodiscard]] std::optional<Found> at(int node, double* clearance = nullptr) const;

 private:
  /// The first place where a ray meets the surface.
  struct Hit {
    double distance;  ///< in lengths of the direction; infinite: nothing
    int side = 0;     ///< 1: the outside of a piece, −1: the inside, 0: both at one place
  };
  [[nodiscard]] bool leads_out(int node, const Eigen::Vector3d& direction) const;
  [[nodiscard]] Hit first_hit(int node, const Eigen::Vector3d& direction) const;
  /// How far a ray goes inside of another part; negative: it does not start there.
  [[nodiscard]] double way_inside(int node, const Eigen::Vector3d& direction) const;
  void trace(const Eigen::Vector3d& from, const Eigen::Vector3d& along, int node, Hit& first) const;
  void meet(const Eigen::Vector3d& from, const Eigen::Vector3d& along, int piece, double same, Hit& first) const;

  const BodySurface& surface_;
  bool mirrored_;
};

}  // namespace ricochet
