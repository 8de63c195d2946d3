#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file From a checked document to a Case, with the checks that concern more than one key.
namespace ricochet {

/// What a user should know of a case that is valid.
struct Remarks {
  std::vector<std::string> warnings, infos;
  std::vector<std::string> ignored;  ///< key paths without effect in this run
};

/// Fills every section of `result` but its locations and values.
void read_sections(const TomlNode& root, Case& result, Problems& problems, Remarks& remarks);

/// Newmark's parameters and the length of the run. (In its own file: how beta, gamma, preset and --set go together.)
class SectionReader;
[[nodiscard]] TimeSection read_time(const SectionReader& reader, Remarks& remarks);

}  // namespace ricochet
