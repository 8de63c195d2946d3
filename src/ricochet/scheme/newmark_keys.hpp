#pragma once

#include <vector>

#include "ricochet/base/parameters.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file Newmark's beta and gamma: their keys in a case file, by value or by the name of a preset, and their effect on
/// prescribed displacements.
namespace ricochet {

struct NewmarkParameters {
  double beta = 0.0, gamma = 0.0;  ///< textbook definition
};

[[nodiscard]] std::vector<Key> newmark_keys();
/// Resolves a preset: afterwards `values` contains the effective beta and gamma, and the preset if both come from it.
void check_newmark(const ParameterCheck& check, Parameters& values);
[[nodiscard]] NewmarkParameters newmark_parameters(const Parameters& values);

/// Response of a dof with inertia whose displacement is prescribed, ΔU = hv, to a jump in v. Newmark's formulas leave,
/// whatever the step, for w = V − v and a = hA:
///   a₁ = −[w₀ + (½−β)a₀]/β,   w₁ = w₀ + (1−γ)a₀ + γa₁,
/// a map of determinant 1 + (½−γ)/β and trace 2 − (γ+½)/β. Its eigenvalues are smaller than 1 for γ > ½ and 2β > γ, and
/// some is larger than 1 for γ < ½ or 2β < γ. At β = ¼, γ = ½ both are −1, with one eigenvector: A grows linearly.
[[nodiscard]] JumpResponse newmark_jump_response(const NewmarkParameters& parameters);

}  // namespace ricochet
