#pragma once

#include <string>

#include "ricochet/base/json.hpp"
#include "ricochet/io/summary.hpp"

/// @file What came out of a run, as entries of summary.json: penetration where no contact is, bodies, impacts, the
/// largest stress. Not part of the public interface.
namespace ricochet {

/// A JSON object with these entries.
[[nodiscard]] Json outcome_to_json(const RunSummary& summary);
/// Reads those that the object has. Throws Error(invalid_input), which names the file, or Json::Exception.
void read_outcome(const Json& json, const std::string& path, RunSummary& summary);

}  // namespace ricochet
