#pragma once

#include "ricochet/fem/material.hpp"

/// @file Speeds of elastic waves, too short for stress to relax.
namespace ricochet {

/// Speed of compression waves: √((λ + 2μ)/ρ), with the λ of plane stress if the body is such a section.
[[nodiscard]] double compression_wave_speed(const Material& material, bool plane_stress);
/// Speed of shear waves: √(μ/ρ).
[[nodiscard]] double shear_wave_speed(const Material& material);

}  // namespace ricochet
