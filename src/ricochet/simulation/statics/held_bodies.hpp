#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Bodies that supports fix.
namespace ricochet {

/// Returns whether the supports of some nodes, those of one body, leave it no rigid motion: to first order, at the
/// reference positions.
[[nodiscard]] bool are_fixed_by_supports(const SemidiscreteProblem& problem, const std::vector<Index>& members);

/// Returns whether the supports fix every body.
[[nodiscard]] bool all_are_fixed_by_supports(const SemidiscreteProblem& problem);

/// Returns whether supports fix one body, and none of its prescribed displacements depends on time.
[[nodiscard]] bool are_fixed_at_rest(const SemidiscreteProblem& problem, const std::vector<Index>& members);

}  // namespace ricochet
