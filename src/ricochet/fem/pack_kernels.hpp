#pragma once

#include "ricochet/fem/cell_packs.hpp"
#include "ricochet/fem/kernel_block.hpp"
#include "ricochet/fem/material_law.hpp"

/// @file Kernels for packs of cells, compiled for the best instruction set: gradients of a vector at the quadrature
/// points, strains, and the forces of stresses. Not part of the public interface.
///
/// Data per point of a pack, with contiguous lanes for each number: the displacement gradient H row by
/// row, in 2D followed by H_zz (the hoop strain u_r/r of axisymmetric bodies, else 0); strains and
/// stresses in the order of StrainPacks.
namespace ricochet {

template <int d>
inline constexpr int gradient_components = d == 2 ? 5 : 9;
template <int d>
inline constexpr int strain_components = d == 2 ? 4 : 6;

/// A few consecutive packs.
template <int d>
struct PackStrip {
  const KernelBlock<d>& block;
  const int* slots;  ///< of the block (CellPacks)
  Index begin, end;  ///< packs

  [[nodiscard]] Index points() const { return (end - begin) * block.points; }
};

/// Computes H at all points from the numbers of a part (CellPacks).
template <int d>
void find_gradients(const PackStrip<d>& strip, const double* numbers, double* gradients);

/// Computes Green's strain of H (for the linear law ½(H + Hᵀ)); with the gradients of an increment Δ, the mean of
/// those at H ± ½∇Δ, E + ⅛ (∇Δ)ᵀ∇Δ. Returns whether det F > 0 everywhere (always for the linear law; of the in-plane
/// part alone under plane stress).
template <int d>
[[nodiscard]] bool find_strains(Index points, bool is_linear, const double* gradients, const double* increments,
                                double* strains);

/// Adds ∫ F S ∇φ_a to the numbers of a part; for the linear law F = I.
template <int d>
void add_forces(const PackStrip<d>& strip, bool is_linear, const double* gradients, const double* stresses,
                double* numbers);

/// Adds the correction for mean dilatation: S += (p − U′(J)) J C⁻¹.
template <int d>
void add_mean_pressures(const PackStrip<d>& strip, double modulus, const double* strains, double* stresses);
/// Adds the correction W += U(Θ) − U(J), one number per point and lane.
template <int d>
void add_mean_energies(const PackStrip<d>& strip, double modulus, const double* strains, double* energies);

}  // namespace ricochet
