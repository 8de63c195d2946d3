#pragma once

#include <string>

#include "ricochet/simulation/monitor/penetration_report.hpp"

/// @file Text fragments of messages about penetration.
namespace ricochet::penetration_phrases {

/// "(1, 0.5)"
[[nodiscard]] std::string coordinates(const std::vector<double>& position);
/// "at the start", "at t = 0.2"
[[nodiscard]] std::string when(double time);
/// "3.1e-06 (0.00012 of its size)"
[[nodiscard]] std::string depth_text(const UnwatchedPenetration& p);

inline constexpr const char* check_side =
    "check on which side of the obstacle the body is (the normal of a plane points out of it, other shapes have a "
    "\"side\")";
inline constexpr const char* see_summary = "see \"unwatched_penetration\" in summary.json for the largest depth";

}  // namespace ricochet::penetration_phrases
