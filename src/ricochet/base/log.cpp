#include "ricochet/base/log.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <array>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/base/run_name.hpp"

namespace ricochet::log {

namespace {

/// Names of the levels in the order of Level, and spdlog's levels.
constexpr std::array<std::pair<const char*, spdlog::level::level_enum>, 6> levels{{{"trace", spdlog::level::trace},
                                                                                   {"debug", spdlog::level::debug},
                                                                                   {"info", spdlog::level::info},
                                                                                   {"warning", spdlog::level::warn},
                                                                                   {"error", spdlog::level::err},
                                                                                   {"off", spdlog::level::off}}};

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto created =
        std::make_shared<spdlog::logger>("ricochet", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    created->set_pattern("%^%l%$: %v");
    return created;
  }();
  return *instance;
}

Sink& other_sink() {
  static Sink sink;
  return sink;
}

std::vector<std::string>*& collected_warnings() {
  thread_local std::vector<std::string>* list = nullptr;
  return list;
}

std::string& run_name() {
  static std::string name;
  return name;
}

std::string& run_case_file() {
  static std::string path;
  return path;
}

spdlog::level::level_enum spdlog_level(Level level) { return levels.at(std::size_t(level)).second; }

void write_message(Level level, const std::string& message) {
  if (!enabled(level)) return;
  if (other_sink()) return other_sink()(level, message);
  logger().log(spdlog_level(level), "{}", message);
}

}  // namespace

void set_sink(Sink sink) { other_sink() = std::move(sink); }

Level parse_level(std::string_view name) {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (name == levels[i].first) return static_cast<Level>(i);
  }
  throw Error(ErrorKind::usage,
              fmt::format("unknown log level \"{}\"; use trace, debug, info, warning, error or off", name));
}

void set_level(Level level) { logger().set_level(spdlog_level(level)); }
bool enabled(Level level) { return logger().should_log(spdlog_level(level)); }

void debug(const std::string& message) { write_message(Level::debug, message); }
void info(const std::string& message) { write_message(Level::info, message); }
void warning(const std::string& message) {
  if (collected_warnings() != nullptr) collected_warnings()->push_back(message);
  write_message(Level::warning, with_run_name(message));
}
void error(const std::string& message) { write_message(Level::error, with_run_name(message)); }

void set_run_name(std::string name, std::string case_file) {
  run_name() = std::move(name);
  run_case_file() = std::move(case_file);
}
std::string with_run_name(const std::string& message) {
  const bool has_run_name =
      run_name().empty() || message.starts_with(run_name() + ":") || message.starts_with(run_name() + "/");
  const bool is_about_case = !run_case_file().empty() && message.starts_with(run_case_file() + ":");
  return has_run_name || is_about_case ? message : run_name() + ": " + message;
}

CollectWarnings::CollectWarnings(std::vector<std::string>& list) : before_(collected_warnings()) {
  collected_warnings() = &list;
}
CollectWarnings::~CollectWarnings() { collected_warnings() = before_; }

Silence::Silence() {
  before_ = Level::trace;
  while (!enabled(before_)) before_ = static_cast<Level>(int(before_) + 1);
  set_level(Level::off);
}
Silence::~Silence() { set_level(before_); }

}  // namespace ricochet::log
