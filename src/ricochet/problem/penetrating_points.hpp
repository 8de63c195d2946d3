#pragma once

#include <optional>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Contact points that penetrate their counterpart.
namespace ricochet {

/// Penetrating points of the whole body; `points` is local to the rank.
struct PenetratingPoints {
  std::vector<Index> points;  ///< of this rank, ascending
  Index count = 0;
  double deepest = 0.0;  ///< length, positive
  int pair = -1;         ///< of the deepest point, as in ContactBoundary::pair
  Vector position;       ///< undeformed position of the deepest point; empty if there is none
};

/// Returns the contact points with a gap below −`depth` (≥ 0) and below zero by more than rounding, of one pair or of
/// all. `gap`: gaps of all contact points. Collective over the ranks.
[[nodiscard]] PenetratingPoints penetrating_points(const SemidiscreteProblem& problem, const Vector& gap,
                                                   std::optional<int> pair = {}, double depth = 0.0);

/// Returns the points that penetrate at t = 0 with a displacement.
[[nodiscard]] PenetratingPoints initially_penetrating_points(const SemidiscreteProblem& problem,
                                                             const Vector& displacement);

}  // namespace ricochet
