#pragma once

#include "ricochet/contact/contact_boundary.hpp"

/// @file Stress of the body at its contact points, a linear function of the displacement.
namespace ricochet {

struct ContactStress {
  /// S, points × dofs. s_i = D_i Σ_j c_ij n_i·(σN)_j is the reaction at point i in equilibrium with the stress inside
  /// the body, positive in compression: N is the body's outward normal, n_i the obstacle's, and (σN)_j at a node is the
  /// mean over the contact facets around it by area, with σ of the cell behind each. Rigid motions cause none.
  SparseRowMatrix rows;
  /// κ, a stiffness per point with Σ s_i²/κ_i ≤ UᵀKU for every displacement U.
  Vector stiffness;
};

/// Computes it for a linear elastic body, with the normals of `boundary.rows`. A facet
/// between two cells uses the first.
[[nodiscard]] ContactStress make_contact_stress(const Body& body, const ContactBoundary& boundary);

}  // namespace ricochet
