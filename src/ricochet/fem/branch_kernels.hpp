#pragma once

#include "ricochet/fem/pack_kernels.hpp"
#include "ricochet/fem/relaxation.hpp"

/// @file Viscoelastic branches (relaxation.hpp) of packs of cells. Not part of the public interface.
namespace ricochet {

/// Number of components of an internal strain: xx, yy, zz, xy, yz, zx.
inline constexpr Index internal_components = 6;

/// Branch of a material over a step.
struct BranchNumbers {
  double modulus;  ///< gμ
  RelaxationRule rule;
};

/// Quadrature points of a strip, all of one material.
template <int d>
struct BranchPoints {
  Index packs;
  int points;  ///< per cell
  const std::vector<BranchNumbers>& branches;
  /// Per lane the internal strains of the cell, point by point; for unused lanes those of any cell.
  const double* const* internal;
  /// Green's strains in the order of StrainPacks, only those that are needed: Ē of a step, at its start
  /// and end, and at a displacement.
  const double *middle = nullptr, *start = nullptr, *end = nullptr, *at = nullptr;
};

enum class BranchStress {
  mean,  ///< of q̄
  end    ///< of q₁
};
/// Computes Σ 2gμ q.
template <int d>
void find_branch_stresses(BranchStress of, const BranchPoints<d>& points, double* stresses);

enum class BranchWork {
  energy,        ///< at the displacement
  start_energy,  ///< potential at the displacement
  dissipation    ///< of the step
};
/// Computes the sum over the branches, one number per point and lane. Also writes A₁ per lane if `next` is not null
/// (null entries: unused lanes).
template <int d>
void find_branch_works(BranchWork of, const BranchPoints<d>& points, double* const* next, double* works);

/// Sets the internal strains of all branches to the deviator at the displacement.
template <int d>
void relax_branches(const BranchPoints<d>& points, double* const* next);

}  // namespace ricochet
