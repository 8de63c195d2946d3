#pragma once

#include <string>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The surfaces of the obstacles, shown beside the body.
namespace ricochet {

/// Made once, around the body at the start, and then moved: cells and their points are the same in all frames.
class ObstacleSurfaces {
 public:
  /// Keeps references to the obstacles.
  explicit ObstacleSurfaces(const SemidiscreteProblem& problem);

  [[nodiscard]] bool any() const { return !obstacles_.empty(); }
  [[nodiscard]] int corners() const { return corners_; }                      ///< of a cell: 2 in the plane, 4 in space
  [[nodiscard]] Index point_count() const { return point_count_; }            ///< of all
  [[nodiscard]] const std::vector<int>& cells() const { return cells_; }      ///< cells × corners, numbers of points
  [[nodiscard]] const std::vector<int>& numbers() const { return numbers_; }  ///< for each cell its obstacle's, from 0
  /// Points × 3 at a time and a displacement.
  [[nodiscard]] std::vector<double> positions(double time, const Vector& displacement) const;
  /// All of them as an XDMF <Grid>; the cell field "obstacle" has the numbers.
  [[nodiscard]] std::string grid(double time, const Vector& displacement) const;

 private:
  std::vector<const Obstacle*> obstacles_;  ///< each once
  std::vector<Points> points_;              ///< of each, at t = 0
  Index point_count_ = 0;
  int corners_ = 2;
  std::vector<int> cells_, numbers_;
  std::string topology_text_, numbers_text_;  ///< as they stand in each grid
};

}  // namespace ricochet
