#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Broad phase for many pairs of surfaces: detection of pairs too far apart to come into contact in a step.
namespace ricochet {

/// Distance (length) within which points have rows: four times the motion of the step plus a tenth of a cell's height,
/// since two surfaces approach by at most twice the motion, and forces may move points farther in a step than predicted
/// when its rows were computed.
[[nodiscard]] inline double reach_of_sliding(double way, double height) { return 4.0 * way + 0.1 * height; }

/// Bounding boxes of surfaces, each of which many pairs may share. A gap is no less than the distance of two boxes, so
/// that points of a pair whose boxes are farther apart than their reach would have no rows in any case. Only pairs from
/// contact of every body with every other are tested. Does not allocate after construction.
class BroadPhase {
 public:
  /// `nodes`: reference positions.
  BroadPhase(const std::vector<std::unique_ptr<SlidingPair>>& pairs, const Points& nodes);

  /// Number of pairs that are tested.
  [[nodiscard]] Index count() const { return count_; }
  [[nodiscard]] bool may_be_apart(std::size_t pair) const { return pairs_[pair].first >= 0; }
  /// Moves the surfaces to a displacement or, with `start` (may be null), to the hull of the motion from there.
  void move(const Vector& displacement, const Vector* start);
  [[nodiscard]] bool are_apart(std::size_t pair) const;

 private:
  struct Surface {
    std::vector<Index> nodes;
    Eigen::AlignedBox3d box;
    double way = 0.0;  ///< largest displacement of a node over the step
  };
  struct Pair {
    int first = -1, second = -1;  ///< surfaces; −1 if the pair is not tested
    double height = 0.0;
  };

  Points nodes_;
  std::vector<Surface> surfaces_;
  std::vector<Pair> pairs_;
  Index count_ = 0;
};

}  // namespace ricochet
