#pragma once

#include "ricochet/fem/assembly.hpp"

/// @file Strain that is invariant under rotations.
namespace ricochet {

/// Largest magnitude of the principal values of Green's strain ½ (∇u + ∇uᵀ + ∇uᵀ∇u) at the centres of all cells. It is
/// zero for every rigid motion, whereas small strain ½ (∇u + ∇uᵀ) is cos θ − 1 in the plane of a rotation by θ.
[[nodiscard]] double largest_green_strain(const Body& body, const Vector& displacement);

}  // namespace ricochet
