#pragma once

#include <nlohmann/json.hpp>

#include "ricochet/io/summary.hpp"

/// @file What came out of a run, as entries of summary.json: bodies, impacts, the largest stress. Not part of the
/// public interface.
namespace ricochet {

using Json = nlohmann::ordered_json;

/// JSON has no infinities; a summary says them in words.
[[nodiscard]] Json number(double value);
[[nodiscard]] double to_number(const Json& value);

[[nodiscard]] Json bodies_to_json(const RunSummary& summary);
[[nodiscard]] Json impacts_to_json(const RunSummary& summary);
[[nodiscard]] Json peak_stress_to_json(const RunSummary& summary);
/// Reads the three of them, where they are. Throws Json::exception or Error(invalid_input).
void read_outcome(const Json& json, RunSummary& summary);

}  // namespace ricochet
