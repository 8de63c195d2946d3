#pragma once

#include <optional>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/statics/static_equilibrium.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file The state at t = 0.
namespace ricochet {

struct InitialConditions {
  bool static_equilibrium = false;  ///< the displacement is the equilibrium under the loads at t = 0, contact included
  Vector displacement;              ///< per dof, otherwise
  Vector velocity;                  ///< per dof
  /// The equilibrium, where it was found before: of a body that was divided after it.
  std::optional<StaticEquilibrium> found = {};
};

/// From the undeformed body; warns of gaps that it closes. Throws Error(invalid_input) or Error(not_converged) which
/// says why there is none, and where the body lies inside of something.
[[nodiscard]] StaticEquilibrium find_static_equilibrium(const SemidiscreteProblem& problem, const Vector& velocity,
                                                        const StepSolverOptions& options);

/// Displacement, velocity, acceleration and forces that satisfy the momentum equation at t = 0:
///   supported dofs take their prescribed displacement, and velocity and acceleration from its first values (spacing
///   h); with a singular mass the contact dofs take their equilibrium K_cc u_c = L_c − K_ci u_i + (Gᵀr)_c, contact
///   included; M a = L − K U − C V + Gᵀ r_N − B_Tᵀ r_T on the other dofs, where a contact point at rest on its obstacle
///   has 0 ≤ r ⟂ G a ≥ 0.
/// What it changes in the given displacement and velocity is said in the log.
[[nodiscard]] State make_starting_state(const SemidiscreteProblem& problem, const InitialConditions& initial,
                                        double step, const StepSolverOptions& options = {});

}  // namespace ricochet
