#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"

/// @file Reading a case file.
namespace ricochet {

/// Parses and checks a case file, with `--set key.path=value` overrides applied first. Throws Error(file_access) when
/// it cannot be read and Error(invalid_input) with every problem found (one per line, file:line:column first).
[[nodiscard]] Case read_case(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same of a text; `path` names it in messages, and files that it names are relative to that.
[[nodiscard]] Case read_case_text(const std::string& text, const std::string& path,
                                  const std::vector<std::string>& overrides = {});

/// JSON Schema (draft 2020-12) of the case file, from the table of keys that read_case checks against.
[[nodiscard]] std::string case_schema();

/// The documentation page of the case file, in Markdown, from the same table.
[[nodiscard]] std::string case_reference();

}  // namespace ricochet
