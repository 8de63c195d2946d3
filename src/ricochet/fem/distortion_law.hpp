#pragma once

#include "ricochet/fem/material_law.hpp"

/// @file Energy that keeps the volume ratio at the nodes of cells positive (distortion_control.hpp). Not a material.
namespace ricochet {

/// Volume ratio J₀ below which the law has stress, and the one below which it is part of the equations of a step.
inline constexpr double distortion_volume_ratio = 0.2, distortion_watch_ratio = 0.4;

/// Returns the law W = k (1 − j)³/j for j = J/J₀ < 1, else 0, with k = `stiffness`. It has two continuous derivatives.
[[nodiscard]] std::shared_ptr<const MaterialLaw> make_distortion_law(double stiffness);

}  // namespace ricochet
