#pragma once

#include <string>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The surfaces of the obstacles as XDMF shows them beside the body.
namespace ricochet {

class ObstacleSurfaces {
 public:
  /// Keeps a reference.
  explicit ObstacleSurfaces(const SemidiscreteProblem& problem);

  [[nodiscard]] bool any() const { return !obstacles_.empty(); }
  /// A <Grid> with all of them at a time; the cell field "obstacle" numbers them from 0.
  [[nodiscard]] std::string grid(double time) const;

 private:
  std::vector<const Obstacle*> obstacles_;  ///< each once
  Vector centre_;                           ///< of the box around the body
  double radius_ = 0.0;
};

}  // namespace ricochet
