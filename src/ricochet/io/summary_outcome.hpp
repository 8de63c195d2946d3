#pragma once

#include <array>
#include <string>

#include "ricochet/io/summary.hpp"

/// @file What came out of a run, as entries of summary.json: penetration where no contact is, bodies, impacts, the
/// largest stress. Not part of the public interface.
namespace ricochet {

/// The names of these entries, in their order.
inline constexpr std::array outcome_entries{"unwatched_penetration", "bodies",   "impacts",
                                            "impacts_left_out",      "rotation", "peak_stress"};

/// A JSON object with these entries.
[[nodiscard]] std::string outcome_to_json(const RunSummary& summary);
/// Reads those that the object has. Throws Error(invalid_input), which names the file.
void read_outcome(const std::string& json, const std::string& path, RunSummary& summary);

}  // namespace ricochet
