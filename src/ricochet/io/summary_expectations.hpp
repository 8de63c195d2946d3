#pragma once

#include <vector>

#include "ricochet/base/json.hpp"
#include "ricochet/io/summary.hpp"

/// @file Results of the [[expect]] entries in summary.json. Not part of the public interface.
namespace ricochet {

[[nodiscard]] Json expectations_to_json(const std::vector<ExpectationResult>& expectations);
/// Reads them from a whole summary. Throws Json::Exception.
[[nodiscard]] std::vector<ExpectationResult> read_expectations(const Json& summary);

}  // namespace ricochet
