#pragma once

#include <optional>

#include "ricochet/simulation/monitor/body_surface.hpp"

/// @file Self-penetration: nodes of a body's surface that have passed through the surface of the same body.
///
/// A ray from a node out of the body first meets the outside of another part of the surface, or nothing. If it first
/// meets the inside of a part, the node lies inside that part. The depth is the distance to the surface through which
/// the node has passed: the closest piece that faces the node's own surface and has the node behind it, or, if less,
/// the remaining distance along a ray. Rays that meet both sides at one position graze an edge and are inconclusive,
/// and so is a node whose pieces have no common outside. All of the up to three rays that lead out of the node's own
/// pieces must agree, so that rounding of a single one does not produce a false positive.
namespace ricochet {

/// Detection of self-penetration at single nodes. Allocates nothing.
class SelfOverlap {
 public:
  struct Found {
    double depth = 0.0;
    int own_piece = -1;    ///< of the pieces around the node, the one that faces the other piece most
    int other_piece = -1;  ///< piece through which the node has passed
  };

  /// `mirrored`: the surface is the half of a section on one side of the axis x = 0, without pieces on the axis; its
  /// mirror image is the other half. Keeps a reference.
  SelfOverlap(const BodySurface& surface, bool mirrored) : surface_(surface), mirrored_(mirrored) {}

  /// Smallest cosine between the normal at a node and those of the pieces around it: small at notches and sharp edges,
  /// where a normal hardly distinguishes inside and outside. A notch whose sides have crossed looks like an edge.
  [[nodiscard]] double opening(int node) const;
  /// Checks a node, by its number on the surface, in the current positions; nullopt if it is in no other part.
  /// `clearance`: distance from the node along its normal to the outside of another part; infinite if there is none.
  [[nodiscard]] std::optional<Found> at(int node, double* clearance = nullptr) const;

 private:
  /// First intersection of a ray with the surface.
  struct Hit {
    double distance;  ///< in lengths of the direction; infinite: none
    int side = 0;     ///< 1: the outside of a piece, −1: the inside, 0: both at one position
  };
  [[nodiscard]] bool leads_out(int node, const Eigen::Vector3d& direction) const;
  [[nodiscard]] Hit first_hit(int node, const Eigen::Vector3d& direction) const;
  /// Distance along a ray inside another part; negative if the ray does not start inside one.
  [[nodiscard]] double way_inside(int node, const Eigen::Vector3d& direction) const;
  void trace(const Eigen::Vector3d& from, const Eigen::Vector3d& along, int node, Hit& first) const;
  void meet(const Eigen::Vector3d& from, const Eigen::Vector3d& along, int piece, double same, Hit& first) const;

  const BodySurface& surface_;
  bool mirrored_;
};

}  // namespace ricochet
