#pragma once

#include "ricochet/fem/cell_packs.hpp"
#include "ricochet/fem/isotropic_elasticity.hpp"
#include "ricochet/fem/kernel_block.hpp"
#include "ricochet/fem/material_law.hpp"

/// @file What is computed of packs of cells, each for the best instruction set: gradients of a vector at the quadrature
/// points, strains, and the forces of stresses. Not part of the public interface.
///
/// Of every point of a pack there are so many numbers, each once per lane side by side: the displacement's gradient H
/// row by row, in the plane with H_zz after it (the hoop strain u_r/r of axisymmetric bodies, else 0); strains and
/// stresses as StrainPacks has them.
namespace ricochet {

template <int d>
inline constexpr int gradient_components = d == 2 ? 5 : 9;
template <int d>
inline constexpr int strain_components = d == 2 ? 4 : 6;

/// A few packs, one after another.
template <int d>
struct PackStrip {
  const KernelBlock<d>& block;
  const int* slots;  ///< of the block (CellPacks)
  Index begin, end;  ///< packs

  [[nodiscard]] Index points() const { return (end - begin) * block.points; }
};

/// H at all points, of the numbers of a part (CellPacks).
template <int d>
void find_gradients(const PackStrip<d>& strip, const double* numbers, double* gradients);

/// Green's strain of H (of the linear law ½(H + Hᵀ)); with the gradients of an increment Δ that of the mean of both
/// ends, E + ⅛ (∇Δ)ᵀ∇Δ. Returns whether det F > 0 everywhere (that of the linear law, and of the plane alone under
/// plane stress).
template <int d>
[[nodiscard]] bool find_strains(Index points, bool is_linear, const double* gradients, const double* increments,
                                double* strains);

/// The stress of a linear law of the derivative of E along an increment, ½(Fᵀ∇Δ + (∇Δ)ᵀF).
template <int d>
void find_rate_stresses(Index points, const IsotropicElasticity& law, const double* gradients, const double* increments,
                        double* stresses);

/// Adds ∫ F S ∇φ_a to the numbers of a part; of the linear law F = I.
template <int d>
void add_forces(const PackStrip<d>& strip, bool is_linear, const double* gradients, const double* stresses,
                double* numbers);

/// Of mean dilatation: S += (p − U′(J)) J C⁻¹.
template <int d>
void add_mean_pressures(const PackStrip<d>& strip, double modulus, const double* strains, double* stresses);
/// W += U(Θ) − U(J), one number per point and lane.
template <int d>
void add_mean_energies(const PackStrip<d>& strip, double modulus, const double* strains, double* energies);

}  // namespace ricochet
