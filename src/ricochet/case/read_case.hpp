#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"

/// @file Reading of case files.
namespace ricochet {

/// Parses and checks a case file, after applying overrides `--set key.path=value`. Throws Error(file_access) if it
/// cannot be read and Error(invalid_input) with all problems found (one per line, file:line:column first).
[[nodiscard]] Case read_case(const std::string& path, const std::vector<std::string>& overrides = {});

/// As above for a text; `path` names it in messages, and files in it are relative to that path.
[[nodiscard]] Case read_case_text(const std::string& text, const std::string& path,
                                  const std::vector<std::string>& overrides = {});

/// JSON Schema (draft 2020-12) of the case file, from the table of keys that read_case checks against.
[[nodiscard]] std::string case_schema();

/// Documentation page of the case file, in Markdown, from the same table.
[[nodiscard]] std::string case_reference();

}  // namespace ricochet
