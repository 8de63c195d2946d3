#pragma once

#include <string>
#include <vector>

#include "completion.hpp"

/// @file Completion of keys of the case file and of their values, from the table of keys.
namespace ricochet::program {

/// For `--set`: "time.scheme=" and the like, or, behind the "=", the values that a key may have where these have names.
/// Entries of lists and named sections are those of the case file, which may be "" or missing: there are none then.
[[nodiscard]] std::vector<Candidate> settings_of(const std::string& case_file, const std::string& typed);
/// The keys alone.
[[nodiscard]] std::vector<Candidate> keys_of(const std::string& case_file);

}  // namespace ricochet::program
