#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ricochet/simulation/penetration_watch.hpp"

/// @file The entry "unwatched_penetration" of summary.json. Private to io/.
namespace ricochet {

/// The deepest first, by itself, so that it can be named by its path (summary.unwatched_penetration.depth); then all.
[[nodiscard]] nlohmann::ordered_json to_json(const PenetrationReport& report);
/// Throws nlohmann's exceptions.
[[nodiscard]] PenetrationReport penetration_report_from_json(const nlohmann::ordered_json& json);

}  // namespace ricochet
