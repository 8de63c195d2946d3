#include "ricochet/study/study.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "ricochet/base/child_processes.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/run/run_identity.hpp"
#include "ricochet/study/run_state.hpp"
#include "ricochet/study/study_progress.hpp"

namespace ricochet {

namespace {

/// Where a run of a study leaves what it says.
constexpr const char* messages_file = "messages.txt";

/// A study of which nothing could run is a mistake in the case, or in what varies.
void require_one_valid_case(const Study& study) {
  std::optional<Error> first;
  for (const StudyRun& run : study.runs) {
    try {
      static_cast<void>(read_case(study.plan.case_path, run.planned.settings));
      return;
    } catch (const Error& problem) {
      if (!first) first = problem;
    }
  }
  throw Error(first->kind(), fmt::format("study: no run of it could start; the first one says:\n{}", first->what()));
}

/// Runs that are done stay only where the case still is what they ran.
void require_runs_of_this_case(const Study& study) {
  for (const StudyRun& run : study.runs) {
    const RunState state = read_run_state(study.path(run));
    if (!state.summary || state.summary->parameters.empty()) continue;
    try {
      require_same_case(read_case(study.plan.case_path, run.planned.settings), state.summary->version,
                        state.summary->parameters, study.path(run));
    } catch (const Error& problem) {
      throw Error(problem.kind(), fmt::format("{}\nthe runs of this study are not those of its case any more: choose "
                                              "another directory with -o, or start anew over it with --force",
                                              problem.what()));
    }
  }
}

void refuse_other_results(const std::string& directory, const StudyOptions& options) {
  if (holds_run(directory)) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: holds a run; choose another directory for the study with -o", directory));
  }
  if (!holds_study(directory) || options.resume || options.force) return;
  throw Error(ErrorKind::file_access,
              fmt::format("{}: holds a study already; go on with it, or add runs to it, with --resume, choose another "
                          "directory with -o, or start anew over it with --force",
                          directory));
}

/// Only what the study itself says is its own.
void remove_old_study(const std::string& directory) {
  const Study before = read_study(directory);
  for (const StudyRun& run : before.runs) {
    std::error_code problem;
    std::filesystem::remove_all(before.path(run), problem);
    if (problem) {
      throw Error(ErrorKind::file_access,
                  fmt::format("{}: cannot be removed: {}", before.path(run), problem.message()));
    }
  }
}

Study prepare_study(const std::string& directory, const StudyPlan& plan, const StudyQuestions& questions,
                    const StudyOptions& options) {
  Study study{directory, plan, questions, number_runs(plan)};
  require_one_valid_case(study);
  if (holds_study(directory) && options.force) remove_old_study(directory);
  if (holds_study(directory) && options.resume) {
    study.runs = take_over_runs(plan, read_study(directory));
    require_runs_of_this_case(study);
  }
  write_study(study);
  return study;
}

/// Runs that are still to be run, and what is known of them on the way.
class StudyRunner {
 public:
  StudyRunner(const Study& study, const StudyOptions& options);
  /// The signal that has stopped it, or 0.
  int run();

 private:
  [[nodiscard]] ChildProcess start(std::size_t i);
  void end(std::size_t i, const ChildOutcome& outcome);
  [[nodiscard]] const StudyRun& run_at(std::size_t i) const { return study_.runs[pending_[i]]; }

  const Study& study_;
  const StudyOptions& options_;
  std::vector<std::size_t> pending_;
  std::vector<NextAction> actions_;
  std::optional<StudyProgress> progress_;
};

StudyRunner::StudyRunner(const Study& study, const StudyOptions& options) : study_(study), options_(options) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const RunState state = read_run_state(study.path(study.runs[i]));
    const NextAction action = next_action(state);
    kept += action == NextAction::nothing && state.word() != "done";
    if (action == NextAction::nothing) continue;
    pending_.push_back(i);
    actions_.push_back(action);
  }
  if (kept > 0) {
    log::info(fmt::format("{} refused or failed and would again: its directory says why; remove it to try again",
                          counted(kept, "run")));
  }
  progress_.emplace(study.runs.size(), study.runs.size() - pending_.size(), options.quiet);
}

int StudyRunner::run() {
  if (pending_.empty()) return 0;
  // Until there are new ones: what the old tables say will not be so any more.
  for (const char* file : {"study.csv", "study.md"}) {
    std::error_code ignored;
    std::filesystem::remove(study_.path(file), ignored);
  }
  PoolWork work;
  work.make = [this](std::size_t i) { return start(i); };
  work.ended = [this](std::size_t i, const ChildOutcome& outcome) { end(i, outcome); };
  work.watch = [this] { progress_->watch(); };
  work.stop_signal = options_.stop_signal;
  const int signal = run_children(pending_.size(), options_.jobs, work);
  progress_.reset();
  return signal;
}

ChildProcess StudyRunner::start(std::size_t i) {
  const std::string directory = study_.path(run_at(i));
  std::error_code problem;
  std::filesystem::create_directories(directory, problem);
  if (problem) throw Error(ErrorKind::file_access, fmt::format("{}: cannot be made: {}", directory, problem.message()));
  record_outcome(directory, 0, "");
  ChildProcess child;
  child.arguments = {"/proc/self/exe", "run", study_.plan.case_path, "-o", directory};
  for (const std::string& setting : run_at(i).planned.settings) {
    child.arguments.emplace_back("--set");
    child.arguments.push_back(setting);
  }
  child.arguments.insert(child.arguments.end(), {"--threads", std::to_string(options_.threads), "--quiet"});
  // What is left of a run that has no checkpoint is written over.
  child.arguments.emplace_back(actions_[i] == NextAction::resume ? "--resume" : "--force");
  child.output = directory + "/" + messages_file;
  progress_->begin(directory);
  return child;
}

void StudyRunner::end(std::size_t i, const ChildOutcome& outcome) {
  const std::string directory = study_.path(run_at(i));
  // As a shell has it, where something from outside has killed the process.
  const int status = WIFSIGNALED(outcome.status) ? 128 + WTERMSIG(outcome.status) : outcome.exit_status();
  std::string message = last_error(read_file(directory + "/" + messages_file), directory);
  if (message.empty()) message = fmt::format("its process {}", outcome.description());
  const bool was_stopped = status >= 128 && options_.stop_signal && options_.stop_signal() != 0;
  if (!was_stopped) record_outcome(directory, status, message);
  progress_->end(directory, was_stopped ? "interrupted" : status == 0 ? "done" : message);
}

}  // namespace

StudyResults conduct_study(const std::string& directory, const StudyPlan& plan, const StudyQuestions& asked,
                           const StudyOptions& options, int& signal) {
  check_plan(plan);
  const StudyQuestions questions = checked_questions(asked, plan);
  refuse_other_results(directory, options);
  const RunDirectory lock(directory);
  const Study study = prepare_study(directory, plan, questions, options);
  signal = StudyRunner(study, options).run();
  StudyResults results = make_study_table(study);
  write_study_table(study, results);
  return results;
}

}  // namespace ricochet
