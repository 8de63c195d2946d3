#pragma once

#include "ricochet/fem/pack_kernels.hpp"

/// @file Kernels for the path of the strain over a step (strain_path.hpp), for the points of a strip. Tensors are in
/// the order of StrainPacks. Not part of the public interface.
namespace ricochet {

/// Computes ΔE = ½(F_xᵀ∇Δ̂ + (∇Δ̂)ᵀF_x) from the gradients of x and of Δ̂ = u₁ − u⁺, with x = ½(u⁺ + u₁).
template <int d>
void find_strain_changes(Index points, const double* gradients, const double* increments, double* changes);

/// Computes Ē + τ ΔE.
template <int d>
void move_along(Index points, const double* means, const double* changes, double tau, double* strains);

/// Adds tensors times a weight per cell; `weights` has one number per pack of the strip and lane.
template <int d>
void add_weighted(const PackStrip<d>& strip, const double* weights, const double* tensors, double* sums);

/// Computes A : B, one number per point and lane.
template <int d>
void find_products(Index points, const double* a, const double* b, double* products);

}  // namespace ricochet
