#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file The state at t = 0.
namespace ricochet {

struct InitialConditions {
  bool static_equilibrium = false;  ///< the displacement is the equilibrium under the loads at t = 0, contact included
  Vector displacement;              ///< per dof, otherwise
  Vector velocity;                  ///< per dof
};

/// Displacement, velocity, acceleration and forces that satisfy the momentum equation at t = 0:
///   supported dofs take their prescribed displacement, and velocity and acceleration from its first values (spacing
///   h); with a singular mass the contact dofs take their equilibrium K_cc u_c = L_c − K_ci u_i + (Gᵀr)_c, contact
///   included; M a = L − K U − C V + Gᵀ r on the other dofs, where a contact point at rest on its obstacle has 0 ≤ r ⟂
///   G a ≥ 0.
/// What it changes in the given displacement and velocity is said in the log.
[[nodiscard]] State make_starting_state(const SemidiscreteProblem& problem, const InitialConditions& initial,
                                        double step);

struct StaticEquilibrium {
  Vector displacement;
  Vector normal_reaction;  ///< r_N, per contact point
};

/// Equilibrium K U = L(0) + Gᵀ r with contact and supports, from a starting guess. Bodies that only contact holds are
/// treated by the proximal point method: (εM + K)(U_{k+1} − U_k) = L − K U_k + Gᵀr, which converges to the equilibrium
/// itself for any ε > 0 if there is one. Throws Error(invalid_input) when there is none, with the force left over.
[[nodiscard]] StaticEquilibrium static_equilibrium(const SemidiscreteProblem& problem, const Vector& guess);

}  // namespace ricochet
