#pragma once

#include <string>
#include <vector>

#include "completion.hpp"

/// @file Completion of keys of the case file and of their values, from the table of keys.
namespace ricochet::program {

/// Completes `--set`: "time.scheme=" and the like or, after the "=", the values of the key if these have names. Entries
/// of lists and named sections are those of the case file, which may be "" or missing, and then has none.
[[nodiscard]] std::vector<Candidate> settings_of(const std::string& case_file, const std::string& typed);
/// Completes keys only.
[[nodiscard]] std::vector<Candidate> keys_of(const std::string& case_file);

}  // namespace ricochet::program
