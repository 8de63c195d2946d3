#include "ricochet/study/run_pool.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "ricochet/base/child_processes.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/study/run_state.hpp"

namespace ricochet {

namespace {

/// Seconds between two readings of the summaries of runs, which are written every two seconds.
constexpr double redraw_interval = 0.5;

/// Returns the fraction of its steps that a run has completed, from its summary.
double part_done(const std::string& directory) {
  try {
    return read_summary(directory + "/summary.json").part_done();
  } catch (const Error&) {  // no summary yet
    return 0.0;
  }
}

/// Progress of many runs on standard error: a bar on a terminal, else a line for each run that ends.
class StudyProgress {
 public:
  /// Shows the progress of so many runs, some of which had ended before.
  StudyProgress(std::size_t runs, std::size_t ended_before, bool quiet);
  /// Ends the line of the bar if it is open.
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;

  void begin(const std::string& directory);
  /// `words`: the state in which it ended.
  void end(const std::string& directory, const std::string& words);
  /// Updates the progress of the runs from time to time.
  void watch();

 private:
  void draw();
  /// Returns the number of completed runs, including fractions of those in progress.
  [[nodiscard]] double runs_done() const;
  /// Returns ", 12 s left": an estimate for the remaining runs from those of this command. "" before the first has
  /// progressed.
  [[nodiscard]] std::string time_left(double done) const;

  std::size_t runs_, ended_before_, ended_;
  bool quiet_, terminal_, open_ = false;
  double last_drawn_ = 0.0;
  std::vector<std::string> running_;
  Timer timer_;
};

StudyProgress::StudyProgress(std::size_t runs, std::size_t ended_before, bool quiet)
    : runs_(runs),
      ended_before_(ended_before),
      ended_(ended_before),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0) {}

StudyProgress::~StudyProgress() {
  if (open_) std::fputc('\n', stderr);
}

void StudyProgress::begin(const std::string& directory) { running_.push_back(directory); }

void StudyProgress::end(const std::string& directory, const std::string& words) {
  std::erase(running_, directory);
  ++ended_;
  if (quiet_) return;
  if (terminal_) {
    draw();
  } else {
    fmt::print(stderr, "{}/{}  {}: {}{}\n", ended_, runs_, directory, words, time_left(runs_done()));
  }
}

void StudyProgress::watch() {
  if (!quiet_ && terminal_ && timer_.seconds() - last_drawn_ >= redraw_interval) draw();
}

double StudyProgress::runs_done() const {
  auto done = double(ended_);
  for (const std::string& directory : running_) done += part_done(directory);
  return done;
}

std::string StudyProgress::time_left(double done) const {
  const double here = done - double(ended_before_), left = double(runs_) - done;
  if (!(here > 0.0 && left > 0.0)) return "";
  // The mean time per run includes the number of jobs, which stays the same.
  return fmt::format(", {} left", duration_text(timer_.seconds() / here * left));
}

void StudyProgress::draw() {
  last_drawn_ = timer_.seconds();
  const double done = runs_done();
  constexpr int width = 30;
  const int filled = int(width * done / double(runs_));
  fmt::print(stderr, "\r[{:#<{}}{:.<{}}] {}/{} runs, {} running  {} elapsed{}\033[K", "", filled, "", width - filled,
             ended_, runs_, running_.size(), duration_text(last_drawn_), time_left(done));
  std::fflush(stderr);
  open_ = true;
}

/// Runs that are not complete, and their progress.
class RunPool {
 public:
  RunPool(const std::vector<PooledRun>& runs, const RunPoolOptions& options);
  [[nodiscard]] bool empty() const { return pending_.empty(); }
  /// Returns the signal that has stopped it, or 0.
  int run();

 private:
  [[nodiscard]] ChildProcess start(std::size_t i);
  void end(std::size_t i, const ChildResult& result);
  [[nodiscard]] const PooledRun& run_at(std::size_t i) const { return runs_[pending_[i]]; }

  const std::vector<PooledRun>& runs_;
  const RunPoolOptions& options_;
  std::vector<std::size_t> pending_;
  std::vector<NextAction> actions_;
  std::optional<StudyProgress> progress_;
};

RunPool::RunPool(const std::vector<PooledRun>& runs, const RunPoolOptions& options) : runs_(runs), options_(options) {
  std::size_t skipped = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunState state = read_run_state(runs[i].directory);
    const NextAction action = next_action(state);
    skipped += action == NextAction::nothing && state.status_text() != "done";
    if (action == NextAction::nothing) continue;
    warn_of_other_version(state);
    pending_.push_back(i);
    actions_.push_back(action);
  }
  if (skipped > 0) {
    log::info(fmt::format(
        "{} skipped (refused or failed earlier): see the directory of each for the reason, and remove it to try again",
        counted(skipped, "run")));
  }
  progress_.emplace(runs.size(), runs.size() - pending_.size(), options.quiet);
}

int RunPool::run() {
  PoolWork work;
  work.make = [this](std::size_t i) { return start(i); };
  work.ended = [this](std::size_t i, const ChildResult& result) { end(i, result); };
  work.watch = [this] { progress_->watch(); };
  work.stop_signal = options_.stop_signal;
  const int signal = run_children(pending_.size(), options_.jobs, work);
  progress_.reset();
  return signal;
}

ChildProcess RunPool::start(std::size_t i) {
  const std::string& directory = run_at(i).directory;
  std::error_code problem;
  std::filesystem::create_directories(directory, problem);
  if (problem)
    throw Error(ErrorKind::file_access,
                fmt::format("{}: cannot create this directory: {}", directory, problem.message()));
  record_exit_status(directory, 0, "");
  ChildProcess child;
  child.arguments = {options_.program, "run", run_at(i).case_path, "-o", directory};
  for (const std::string& setting : run_at(i).settings) {
    child.arguments.emplace_back("--set");
    child.arguments.push_back(setting);
  }
  child.arguments.insert(child.arguments.end(), {"--threads", std::to_string(options_.threads), "--quiet"});
  // Remains of a run without a checkpoint are overwritten.
  child.arguments.emplace_back(actions_[i] == NextAction::resume ? "--resume" : "--force");
  child.output = directory + "/" + messages_file;
  progress_->begin(directory);
  return child;
}

void RunPool::end(std::size_t i, const ChildResult& result) {
  const std::string& directory = run_at(i).directory;
  // As shells report it if a signal has killed the process.
  const int status = WIFSIGNALED(result.status) ? 128 + WTERMSIG(result.status) : result.exit_status();
  std::string message = last_error(read_file(directory + "/" + messages_file), directory);
  if (message.empty()) message = fmt::format("its process {}", result.description());
  const bool was_stopped = status >= 128 && options_.stop_signal && options_.stop_signal() != 0;
  if (!was_stopped) record_exit_status(directory, status, message);
  progress_->end(directory, was_stopped ? "interrupted" : status == 0 ? "done" : message);
}

}  // namespace

int run_pool(const std::vector<PooledRun>& runs, const RunPoolOptions& options, const std::function<void()>& before) {
  RunPool pool(runs, options);
  if (pool.empty()) return 0;
  before();
  return pool.run();
}

}  // namespace ricochet
