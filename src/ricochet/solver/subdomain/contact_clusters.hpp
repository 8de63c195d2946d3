#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Contact points in groups that may be solved one apart from the other.
namespace ricochet {

/// Groups of at most `most` points that are near each other, by bisection along the longest side of what they take in
/// space, at the start. Points that see a node in common stay together, however many they are: the contact conditions
/// of both hold to rounding only where one group moves the node. So do those that slide along a body, whose nodes are
/// not known beforehand. Points of a group come in the order in which they were given.
[[nodiscard]] std::vector<std::vector<Index>> cluster_points(const SemidiscreteProblem& problem,
                                                             const std::vector<Index>& points, std::size_t most);

}  // namespace ricochet
