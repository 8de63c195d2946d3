#pragma once

#include <string>
#include <string_view>
#include <vector>

/// @file Messages to the user, on standard error. Warnings are also remembered, so that the summary of a run repeats
/// them.
namespace ricochet::log {

enum class Level { trace, debug, info, warning, error, off };

/// Parses "debug", "info", …; throws Error(usage) that lists the levels.
Level parse_level(std::string_view name);
void set_level(Level level);
[[nodiscard]] bool enabled(Level level);

void debug(const std::string& message);
void info(const std::string& message);
void warning(const std::string& message);
void error(const std::string& message);

/// All warnings since the last call of clear_warnings, in order.
[[nodiscard]] const std::vector<std::string>& warnings();
void clear_warnings();
/// Replaces them, without saying them again: those of an interrupted run that goes on.
void set_warnings(std::vector<std::string> messages);

}  // namespace ricochet::log
