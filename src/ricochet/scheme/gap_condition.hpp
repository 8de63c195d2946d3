#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/stage.hpp"

/// @file The contact condition that most stages have.
namespace ricochet {

/// Every contact point is eligible and y is its gap: y = g₀ + G (base + δ).
inline void require_no_penetration(const SemidiscreteProblem& problem, const Vector& base, Stage& stage) {
  problem.gaps(base, stage.gap_offset);
  stage.gap_offset_rounding = problem.contact.gap_rounding;
  stage.gap_factor = 1.0;
  stage.eligible.assign(static_cast<std::size_t>(problem.contact.size()), 1);
}

}  // namespace ricochet
