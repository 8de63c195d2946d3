#pragma once

#include <optional>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Whether contact, friction and supports can hold a body at all.
namespace ricochet {

/// A rigid motion on which the loads work and against which neither supports nor any admissible reactions do.
struct UnheldMotion {
  Vector centre;            ///< of the body's nodes
  Vector force;             ///< that nothing balances, along the surfaces that it slides on. Zero: only a moment
  bool slides = false;      ///< some contact is pressed in it
  double unbalanced = 0.0;  ///< force and moment (by the body's size) that nothing balances, as a part of the loads
};

/// Looks for reactions r in the friction cones of all contact points (whatever their gaps are) with
///   Rᵀ(L(0) + Gᵀr_N − B_Tᵀr_T) = 0
/// for the rigid motions R, body by body, that supports leave free: the equilibrium of forces and moments, without
/// which there is none of the elastic body. Where none are, what is left over at the best r is a motion as above, in
/// the unit of the loads. This is Farkas' lemma, and no iteration that may or may not converge: the distance of a point
/// to a cone of three or six dimensions, by the columns that come closest (C. L. Lawson, R. J. Hanson, Solving Least
/// Squares Problems, 1974, ch. 23). Only a necessary condition: a body may have such reactions and yet no equilibrium.
/// A friction bound without a coefficient is taken for rough; `frictionless` (per contact point; may be empty): 1 where
/// friction is left out. Returns the body with the largest unbalanced part; nothing where all are held.
[[nodiscard]] std::optional<UnheldMotion> find_unheld_motion(const SemidiscreteProblem& problem,
                                                             const std::vector<char>& frictionless);

}  // namespace ricochet
