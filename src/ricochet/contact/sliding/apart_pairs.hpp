#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Broad phase of many pairs of surfaces: which of them are too far apart to touch in a step.
namespace ricochet {

/// Distance (length) within which points have rows: four times the step's motion plus a tenth of a cell's height, since
/// two surfaces close by at most twice the way, and forces move points farther in a step than was known when its rows
/// were made.
[[nodiscard]] inline double reach_of_sliding(double way, double height) {
  return 4.0 * way + 0.1 * height;
}

/// Boxes around surfaces, each of which many pairs may share. A gap is no less than the distance of two boxes, so that
/// points of a pair whose boxes are farther apart than their reach would have no rows, whatever they see. Only pairs of
/// every body against every other are looked at in this way. Nothing is allocated after the construction.
class ApartPairs {
 public:
  /// `nodes`: reference positions.
  ApartPairs(const std::vector<std::unique_ptr<SlidingPair>>& pairs, const Points& nodes);

  /// Number of pairs that may be apart.
  [[nodiscard]] Index count() const { return count_; }
  [[nodiscard]] bool may_be_apart(std::size_t pair) const { return pairs_[pair].first >= 0; }
  /// Surfaces are at a displacement or, with `start` (null: none), anywhere from there on.
  void move(const Vector& displacement, const Vector* start);
  [[nodiscard]] bool are_apart(std::size_t pair) const;

 private:
  struct Surface {
    std::vector<Index> nodes;
    Eigen::AlignedBox3d box;
    double way = 0.0;  ///< the longest of a node
  };
  struct Pair {
    int first = -1, second = -1;  ///< surfaces; −1: never apart
    double height = 0.0;
  };

  Points nodes_;
  std::vector<Surface> surfaces_;
  std::vector<Pair> pairs_;
  Index count_ = 0;
};

}  // namespace ricochet
