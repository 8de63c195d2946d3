#pragma once

#include <string>

/// @file Name of the run that messages are about, for output that several runs share.
namespace ricochet::log {

/// Sets the prefix of every warning and error that is logged and does not begin with it (collected warnings get none).
/// Empty: no prefix. Messages that begin with a position in the case file concern all of its runs, and get none either.
void set_run_name(std::string name, std::string case_file = {});
[[nodiscard]] std::string with_run_name(const std::string& message);

}  // namespace ricochet::log
