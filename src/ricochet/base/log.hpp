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

/// Takes messages in place of standard error, on the thread that says them; those below the level are not shown to it.
/// An empty one: standard error again. It must not throw.
using Sink = std::function<void(Level, const std::string&)>;
void set_sink(Sink sink);

/// While it lives, warnings of the whole process are appended to a list besides being said; of several the last one
/// made. Sessions that run on two threads at the same time mix theirs.
class CollectWarnings {
 public:
  explicit CollectWarnings(std::vector<std::string>& list);
  ~CollectWarnings();
  CollectWarnings(const CollectWarnings&) = delete;
  CollectWarnings& operator=(const CollectWarnings&) = delete;

 private:
  std::vector<std::string>* before_;
};

/// While it lives, nothing is said; warnings are collected all the same.
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
