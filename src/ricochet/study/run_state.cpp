#include "ricochet/study/run_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

namespace {

constexpr int refused_status = int(ErrorKind::invalid_input), failed_status = int(ErrorKind::not_converged),
              unexpected_status = int(ErrorKind::expectation);

std::string exit_status_path(const std::string& directory) {
  return (std::filesystem::path(directory) / exit_status_file).string();
}

bool is_done(const RunState& state) { return state.summary && state.summary->status == "done"; }

/// Returns a checksum that distinguishes summaries; if there is none, the checksum of an empty text.
std::string summary_checksum(const std::string& directory) {
  const std::string path = (std::filesystem::path(directory) / "summary.json").string();
  std::error_code ignored;
  const std::string text = std::filesystem::exists(path, ignored) ? read_file(path) : "";
  return Checksum().add_bytes(text.data(), text.size()).text();
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::optional<int> RunState::final_status() const {
  const bool ended_well = !exit_status || exit_status == unexpected_status;
  if (is_done(*this) && ended_well) {
    const auto& all = summary->expectations;
    const bool all_hold = std::ranges::all_of(all, [](const auto& e) { return !e.checked || e.holds; });
    return all_hold ? 0 : unexpected_status;
  }
  return exit_status;
}

std::string RunState::status_text() const {
  const std::optional<int> status = final_status();
  if (status == 0 || status == unexpected_status) return "done";
  if (status) return status == refused_status ? "refused" : "failed";
  return summary || has_checkpoint ? "interrupted" : "not run";
}

NextAction next_action(const RunState& state) {
  if (state.status_text() == "done") return NextAction::nothing;
  if (state.exit_status == refused_status) return NextAction::nothing;
  // Status 3 without a summary that states the failure: out of memory, which may not recur.
  const bool knows = state.summary && state.summary->status == "failed";
  if (state.exit_status == failed_status && knows) return NextAction::nothing;
  return state.summary || state.has_checkpoint ? NextAction::resume : NextAction::start;
}

RunState read_run_state(const std::string& directory) {
  RunState state;
  std::error_code ignored;
  try {
    state.summary = find_intact_summary(directory);
  } catch (const VersionError& problem) {
    state.other_version = problem.versions;
    state.message = problem.versions + ": --resume repeats this run";
    return state;
  }
  if (state.summary) state.summary_json = summary_text_of_run(directory);
  state.has_checkpoint = std::filesystem::is_directory(directory, ignored) && !checkpoint_files(directory).empty();
  if (!std::filesystem::exists(exit_status_path(directory), ignored)) return state;
  try {
    const Json json = Json::parse(read_file(exit_status_path(directory)));
    // A summary that has changed means that somebody has resumed the run by hand, and the status of the earlier process
    // no longer matters.
    if (json.at("summary").get<std::string>() != summary_checksum(directory)) return state;
    state.exit_status = json.at("exit_status").get<int>();
    state.message = json.at("message").get<std::string>();
  } catch (const Json::Exception&) {  // the status is unknown, and the run is tried again
  }
  return state;
}

void warn_of_other_version(const RunState& state) {
  if (!state.other_version.empty())
    log::warning(state.other_version + ": this run is repeated, and its results are overwritten");
}

void record_exit_status(const std::string& directory, int exit_status, const std::string& message) {
  std::error_code ignored;
  std::filesystem::remove(exit_status_path(directory), ignored);
  if (exit_status == 0) return;
  const Json record{{"exit_status", exit_status}, {"message", message}, {"summary", summary_checksum(directory)}};
  write_durably(exit_status_path(directory), record.dump(2) + "\n");
}

std::string last_error(const std::string& messages, const std::string& run_name) {
  const std::string begin = "ricochet: ";
  std::size_t at = messages.starts_with(begin) ? 0 : std::string::npos;
  if (const std::size_t later = messages.rfind("\n" + begin); later != std::string::npos) at = later + 1;
  if (at == std::string::npos) return "";
  std::string text = first_line(messages.substr(at + begin.size()));
  if (text.starts_with(run_name + ": ")) text.erase(0, run_name.size() + 2);
  return text;
}

int worse_status(int a, int b) {
  const auto rank = [](int status) {
    constexpr int order[] = {0, unexpected_status, refused_status, failed_status, 4, 1};
    return std::find(std::begin(order), std::end(order), status) - std::begin(order);
  };
  return rank(b) > rank(a) ? b : a;
}

}  // namespace ricochet
