#pragma once

#include <optional>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Test whether contact, friction and supports can hold a body at all.
namespace ricochet {

/// Rigid motion on which the loads do work and against which neither supports nor any admissible reactions do.
struct UnheldMotion {
  Vector centre;            ///< of the body's nodes
  Vector force;             ///< unbalanced, along the surfaces on which it slides. Zero: a moment only
  bool slides = false;      ///< some contact is pressed in the motion
  double unbalanced = 0.0;  ///< unbalanced force and moment (by the body's size), relative to the loads
};

/// Searches for reactions r in the friction cones of all contact points (whatever their gaps are) with
///   Rᵀ(L(0) + Gᵀr_N − B_Tᵀr_T) = 0
/// for the rigid motions R, body by body, that supports leave free: the equilibrium of forces and moments, without
/// which the elastic body has none. If there are none, the residual at the best r is a motion as above, in the unit of
/// the loads. This is Farkas' lemma rather than an iteration that may or may not converge: the distance of a point to a
/// cone of three or six dimensions, by the columns that come closest (C. L. Lawson, R. J. Hanson, Solving Least Squares
/// Problems, 1974, ch. 23). The condition is only necessary: a body may have such reactions and yet no equilibrium. A
/// friction bound without a coefficient counts as rough; `frictionless` (per contact point; may be empty): 1 where
/// friction is excluded. Returns the body with the largest unbalanced fraction; nullopt if all are held.
[[nodiscard]] std::optional<UnheldMotion> find_unheld_motion(const SemidiscreteProblem& problem,
                                                             const std::vector<char>& frictionless);

}  // namespace ricochet
