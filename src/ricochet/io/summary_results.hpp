#pragma once

#include <string>

#include "ricochet/base/json.hpp"
#include "ricochet/io/summary.hpp"

/// @file Physical results in summary.json: penetration without contact, bodies, impacts, largest stress. Not part of
/// the public interface.
namespace ricochet {

/// Returns a JSON object with these entries.
[[nodiscard]] Json summary_results_to_json(const RunSummary& summary);
/// Reads the entries that the object contains. Throws Error(invalid_input), which names the file, or Json::Exception.
void read_summary_results(const Json& json, const std::string& path, RunSummary& summary);

}  // namespace ricochet
