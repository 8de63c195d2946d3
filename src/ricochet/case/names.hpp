#pragma once

#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/fem/material_law.hpp"
#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/rigid/obstacle.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file Names in case files that are defined by other parts of the program: scheme_names(), mass_names(),
/// multiplier_space_names() and field_names() come from their registries, so that registration suffices to make a name
/// valid in a case.
namespace ricochet {

/// Value of time.step that selects adaptive step lengths.
inline constexpr const char* adaptive_steps = "adaptive";

}  // namespace ricochet
