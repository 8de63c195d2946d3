#pragma once

#include "ricochet/base/types.hpp"

/// @file Linearization of a step with its exact tangent.
namespace ricochet {

/// Equations of a step, linear in unknowns z, of which there may be more than dofs, about the present displacements:
///   J z = r + Bᵀρ,   gaps y = q + Y z,   slips w = p + Y_T z,   ρ = (r_N, −r_T),
/// with the contact conditions and Coulomb's law on y and w. B has the rows of the forces of reactions, and Y those of
/// the derivatives of gaps and slips, which may differ. J and Y J⁻¹ Bᵀ need not be symmetric.
struct ExactTangent {
  SparseMatrix matrix;                               ///< J
  Vector right_hand_side;                            ///< r
  SparseRowMatrix normal_force, tangential_force;    ///< B: points × unknowns, (d−1)·points × unknowns
  SparseRowMatrix normal_motion, tangential_motion;  ///< Y and Y_T, likewise
  Vector gap, slip;                                  ///< q, one per point; p, (d−1) per point
  Vector gap_rounding, slip_rounding;                ///< rounding errors of both, one per point
  /// Whether J is to be made stiffer at closed points from the beginning, as the last solution of a sequence required
  /// (solver/exact/exact_stage.hpp, which sets it). An assembly leaves it as it is.
  bool is_stiffened = false;
};

}  // namespace ricochet
