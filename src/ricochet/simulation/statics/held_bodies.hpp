#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Bodies that supports hold.
namespace ricochet {

/// Whether the supports of some nodes, those of one body, leave it no rigid motion: to first order, at the places of
/// the reference.
[[nodiscard]] bool are_held_by_supports(const SemidiscreteProblem& problem, const std::vector<Index>& members);

/// The same of all bodies.
[[nodiscard]] bool all_are_held_by_supports(const SemidiscreteProblem& problem);

/// The same of one, and the supports stay where they are: nothing that they prescribe depends on time.
[[nodiscard]] bool are_held_at_rest(const SemidiscreteProblem& problem, const std::vector<Index>& members);

}  // namespace ricochet
