#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Clusters of contact points that may be solved separately.
namespace ricochet {

/// Returns clusters of at most `max_points` points that are near each other, by bisection along the longest side of
/// their bounding box, at the start. Points with a common node stay together, however many they are: the contact
/// conditions of both hold to rounding only if one cluster moves the node. So do points that slide along a body, whose
/// nodes are not known beforehand. Points of a cluster are in the given order.
[[nodiscard]] std::vector<std::vector<Index>> cluster_points(const SemidiscreteProblem& problem,
                                                             const std::vector<Index>& points, std::size_t max_points);

}  // namespace ricochet
