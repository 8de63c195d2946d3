#pragma once

#include <string>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Surfaces of the obstacles, displayed together with the body.
namespace ricochet {

/// Generated once, around the body at the start, and then moved: cells and their points are the same in all frames.
class ObstacleSurfaces {
 public:
  /// Keeps references to the obstacles.
  explicit ObstacleSurfaces(const SemidiscreteProblem& problem);

  [[nodiscard]] bool any() const { return !obstacles_.empty(); }
  [[nodiscard]] int corners() const { return corners_; }                      ///< per cell: 2 in the plane, 4 in space
  [[nodiscard]] Index point_count() const { return point_count_; }            ///< of all obstacles
  [[nodiscard]] const std::vector<int>& cells() const { return cells_; }      ///< cells × corners, point numbers
  [[nodiscard]] const std::vector<int>& numbers() const { return numbers_; }  ///< per cell: its obstacle, from 0
  /// Positions, points × 3, at a time and a displacement.
  [[nodiscard]] std::vector<double> positions(double time, const Vector& displacement) const;
  /// All surfaces as an XDMF `Grid` element; the cell field "obstacle" has the numbers.
  [[nodiscard]] std::string grid(double time, const Vector& displacement) const;

 private:
  std::vector<const Obstacle*> obstacles_;  ///< without repetition
  std::vector<Points> points_;              ///< per obstacle, at t = 0
  Index point_count_ = 0;
  int corners_ = 2;
  std::vector<int> cells_, numbers_;
  std::string topology_text_, numbers_text_;  ///< as written in each grid
};

}  // namespace ricochet
