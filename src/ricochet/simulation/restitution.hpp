#pragma once

#include <string>

#include "ricochet/simulation/impact.hpp"

/// @file When the ratio of an impact's normal velocities says something of the impact.
namespace ricochet {

/// Why an impact has no restitution: it has not ended; the body began inside; it did not come nearer; or it did, but so
/// slowly beside its sliding, its spin and vibrations, or what other forces did meanwhile, that the ratio would tell of
/// these. Empty: there is one.
[[nodiscard]] std::string why_no_restitution(const Impact& impact);

}  // namespace ricochet
