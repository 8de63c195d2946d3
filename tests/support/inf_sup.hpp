#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file The inf–sup constant of a displacement and a multiplier space on a mesh. A diagnostic: dense algebra of the
/// size of the contact boundary.
namespace ricochet::test_support {

/// Returns β_h = inf_λ sup_v ∫λv / (‖v‖ |λ|_h), with
///   ‖v‖² = ∫ |∇v|² + v²/L² over the body, L its extent, v the normal displacement, zero on held nodes,
///   |λ|_h² = Σ_e h_e ∫_e λ², h_e = |e|^{1/(d−1)} of a facet: a mesh-dependent norm in place of H^{−1/2}.
/// Thus β_h² is the smallest eigenvalue of (C A⁻¹ Cᵀ) λ = β² H λ, with A of ‖·‖², C_ij = ∫ψ_i φ_j = D_i c_ij and H_ij =
/// Σ_e h_e ∫_e ψ_i ψ_j. It has no unit.
///
/// A family of shape-regular meshes is stable if β_h stays above a positive number. In this norm that implies the
/// inf–sup condition in H^{−1/2} with a constant independent of h (an interpolation of the continuous supremum loses at
/// most a multiple of |λ|_h: R. Verfürth, Error estimates for a mixed finite element approximation of the Stokes
/// equations, RAIRO Anal. Numér. 18, 1984, 175–182), and is implied by it on quasi-uniform meshes, by the inverse
/// inequality |λ|_h ≤ C ‖λ‖_{−1/2}. The norm is that of J. Pitkäranta, Boundary subspaces for the finite element method
/// with Lagrange multipliers, Numer. Math. 33, 1979, 273–289.
///
/// Nodal forces are functionals Σ r_i v(x_i); λ is then their L² representative in the trace space, Σ_j μ_j φ_j with
/// ∫λφ_i = r_i.
///
/// `is_held` (may be empty) returns true for nodes whose normal displacement supports hold; multipliers anchored there,
/// or all of whose nodes are held, are left out as in make_contact_boundary. Without multipliers the constant is
/// infinite.
[[nodiscard]] double inf_sup_constant(const Body& body, const std::vector<Index>& facets,
                                      const std::string& multipliers,
                                      const std::function<bool(Index node)>& is_held = {});

}  // namespace ricochet::test_support
