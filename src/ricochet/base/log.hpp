#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// @file Messages to the user, on standard error. Warnings can be collected, so that the summary of a run repeats them.
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

/// Receives messages instead of standard error, on the thread that logs them; messages below the level are not passed
/// to it. An empty function restores standard error. It must not throw.
using Sink = std::function<void(Level, const std::string&)>;
void set_sink(Sink sink);

/// Appends the warnings that this thread logs to a list, in addition to logging them, for its lifetime; if objects are
/// nested, to the list of the innermost.
class CollectWarnings {
 public:
  explicit CollectWarnings(std::vector<std::string>& list);
  ~CollectWarnings();
  CollectWarnings(const CollectWarnings&) = delete;
  CollectWarnings& operator=(const CollectWarnings&) = delete;

 private:
  std::vector<std::string>* before_;
};

/// Suppresses all messages for its lifetime; warnings are collected nevertheless.
class Silence {
 public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  Level before_ = Level::off;
};

}  // namespace ricochet::log
