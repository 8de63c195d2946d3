#pragma once

#include <optional>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Contact points that are inside of what they may touch.
namespace ricochet {

/// Of the whole body, but for `points`.
struct PointsInside {
  std::vector<Index> points;  ///< of this rank, ascending
  Index count = 0;
  double deepest = 0.0;  ///< length, positive
  int pair = -1;         ///< of the deepest, as in ContactBoundary::pair
  Vector place;          ///< of the deepest, in the mesh; empty: there is none
};

/// The contact points with a gap below zero by more than rounding and by more than `depth` (≥ 0), of one pair or of
/// all. `gap`: of every contact point. All ranks call it.
[[nodiscard]] PointsInside points_inside(const SemidiscreteProblem& problem, const Vector& gap,
                                         std::optional<int> pair = {}, double depth = 0.0);

/// Those that a displacement puts inside at t = 0.
[[nodiscard]] PointsInside points_inside_at_start(const SemidiscreteProblem& problem, const Vector& displacement);

}  // namespace ricochet
