#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Bodies that are held by supports.
namespace ricochet {

/// Returns whether the supports of some nodes, those of one body, leave it no rigid motion: to first order, at the
/// reference positions.
[[nodiscard]] bool are_fixed_by_supports(const SemidiscreteProblem& problem, const std::vector<Index>& members);

/// Returns whether this holds for all bodies.
[[nodiscard]] bool all_are_fixed_by_supports(const SemidiscreteProblem& problem);

/// Returns whether this holds for one body whose supports do not move: no prescribed displacement depends on time.
[[nodiscard]] bool are_fixed_at_rest(const SemidiscreteProblem& problem, const std::vector<Index>& members);

}  // namespace ricochet
