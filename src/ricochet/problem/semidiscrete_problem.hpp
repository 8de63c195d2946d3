#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/problem/internal_force.hpp"
#include "ricochet/problem/loads.hpp"

/// @file The semi-discrete problem, eq. (2) of the source:
///   M Ü + C U̇ + K U = L + Gᵀ r_N − B_Tᵀ r_T  (+ support reactions),   0 ≤ r_N ⟂ g₀ + G U ≥ 0.
namespace ricochet {

struct SemidiscreteProblem {
  int dimension = 2;
  Points nodes;          ///< reference positions, d × nodes
  SparseMatrix mass;     ///< M, or M₀ of an equivalent mass; dofs × dofs
  SparseMatrix damping;  ///< C of Rayleigh's form; empty (0 × 0) when there is none
  std::shared_ptr<const InternalForce> internal_force;
  Loads loads;
  Supports supports;
  ContactBoundary contact;

  /// Dofs without inertia: those of the contact nodes when the mass is an equivalent one, else none. Ascending.
  std::vector<Index> massless_dofs;
  std::vector<char> is_massless;  ///< per dof
  /// Dofs of the contact nodes that no support holds, ascending.
  std::vector<Index> contact_dofs;

  [[nodiscard]] Index dof_count() const { return nodes.cols() * dimension; }
  [[nodiscard]] bool has_damping() const { return damping.cols() > 0; }
  [[nodiscard]] bool has_singular_mass() const { return !massless_dofs.empty(); }
  /// Gaps of all contact points at a displacement: g₀ + G U.
  void gaps(const Vector& displacement, Vector& gap) const;
  /// Adds Gᵀ r_N − B_Tᵀ r_T to a force vector. `tangential` may be empty (frictionless).
  void add_contact_force(const Vector& normal, const Vector& tangential, Vector& force) const;
};

/// Fills massless_dofs, is_massless and contact_dofs from contact and supports.
void finish_problem(SemidiscreteProblem& problem, bool mass_without_contact_inertia);

}  // namespace ricochet
