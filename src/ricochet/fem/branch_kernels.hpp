#pragma once

#include "ricochet/fem/pack_kernels.hpp"
#include "ricochet/fem/relaxation.hpp"

/// @file Branches beside a law (relaxation.hpp) of packs of cells. Not part of the public interface.
namespace ricochet {

/// Of an internal strain: xx, yy, zz, xy, yz, zx.
inline constexpr Index internal_components = 6;

/// A branch of a material over a step.
struct BranchNumbers {
  double modulus;  ///< gμ
  RelaxationRule rule;
};

/// Points of a strip, of one material.
template <int d>
struct BranchPoints {
  Index packs;
  int points;  ///< of a cell
  const std::vector<BranchNumbers>& branches;
  /// Per lane the internal strains of the cell, those of a point one after another; where lanes are not used, of any.
  const double* const* internal;
  /// Green's strains as StrainPacks has them, those that are needed: Ē of a step, at its start and its end, and at some
  /// displacement.
  const double *middle = nullptr, *start = nullptr, *end = nullptr, *at = nullptr;
};

enum class BranchStress {
  mean,  ///< of q̄
  end,   ///< of q₁
  start  ///< RelaxationRule::start_stress, at the displacement
};
/// Σ 2gμ q.
template <int d>
void find_branch_stresses(BranchStress of, const BranchPoints<d>& points, double* stresses);

enum class BranchWork {
  energy,        ///< at the displacement
  start_energy,  ///< the potential there
  dissipation    ///< of the step
};
/// Σ over the branches, one number per point and lane. With `next` (or null) A₁, per lane to where that says (null: a
/// lane that is not used).
template <int d>
void find_branch_works(BranchWork of, const BranchPoints<d>& points, double* const* next, double* works);

/// Makes the deviator at the displacement the internal strain of all branches.
template <int d>
void relax_branches(const BranchPoints<d>& points, double* const* next);

}  // namespace ricochet
