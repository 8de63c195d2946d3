#pragma once

#include <string>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The surfaces of the obstacles as XDMF shows them beside the body.
namespace ricochet {

/// Made once, around the body at the start, and then moved: cells and their points are the same in all frames.
class ObstacleSurfaces {
 public:
  /// Keeps references to the obstacles.
  explicit ObstacleSurfaces(const SemidiscreteProblem& problem);

  [[nodiscard]] bool any() const { return !obstacles_.empty(); }
  /// A <Grid> with all of them at a time and a displacement; the cell field "obstacle" numbers them from 0.
  [[nodiscard]] std::string grid(double time, const Vector& displacement) const;

 private:
  std::vector<const Obstacle*> obstacles_;  ///< each once
  std::vector<Points> points_;              ///< of each, at t = 0
  std::string topology_, numbers_;          ///< of the cells and their obstacles, as they stand in each grid
};

}  // namespace ricochet
