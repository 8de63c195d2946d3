#pragma once

#include <optional>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/statics/static_equilibrium.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file State at t = 0.
namespace ricochet {

struct InitialConditions {
  bool static_equilibrium = false;  ///< the displacement is the equilibrium under the loads at t = 0, contact included
  Vector displacement;              ///< per dof, otherwise
  Vector velocity;                  ///< per dof
  /// Equilibrium that was found before the body was divided among ranks.
  std::optional<StaticEquilibrium> found = {};
};

/// Searches from the undeformed body; warns of gaps that it closes. Throws Error(invalid_input) or
/// Error(not_converged), which states why there is no equilibrium and where the body overlaps others or an obstacle.
[[nodiscard]] StaticEquilibrium find_static_equilibrium(const SemidiscreteProblem& problem, const Vector& velocity,
                                                        const StepSolverOptions& options);

/// Displacement, velocity, acceleration and forces that satisfy the momentum equation at t = 0:
///   supported dofs have their prescribed displacement, and velocity and acceleration from its first values (spacing
///   h); with a singular mass the contact dofs have their equilibrium K_cc u_c = L_c − K_ci u_i + (Gᵀr)_c, contact
///   included; M a = L − K U − C V + Gᵀ r_N − B_Tᵀ r_T on the other dofs, where a contact point at rest on its obstacle
///   has 0 ≤ r ⟂ G a ≥ 0.
/// Changes of the given displacement and velocity are logged.
[[nodiscard]] State make_starting_state(const SemidiscreteProblem& problem, const InitialConditions& initial,
                                        double step, const StepSolverOptions& options = {});

}  // namespace ricochet
