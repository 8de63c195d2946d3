#pragma once

#include <string>

/// @file Which run messages are about, where those of several runs may be in one place.
namespace ricochet::log {

/// Put before every warning and error that is said and does not begin with it (not before those that are remembered);
/// empty: nothing is.
void set_run_name(std::string name);
[[nodiscard]] std::string with_run_name(const std::string& message);

}  // namespace ricochet::log
