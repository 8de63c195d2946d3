#include "ricochet/study/study.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/run/run_identity.hpp"
#include "ricochet/study/requested_columns.hpp"
#include "ricochet/study/run_folders.hpp"
#include "ricochet/study/run_pool.hpp"
#include "ricochet/study/run_state.hpp"

namespace ricochet {

namespace {

/// Refuses a study none of whose runs is valid: the case, or its varied values, must be wrong.
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
  throw Error(first->kind(),
              fmt::format("study: none of the runs can start; the first one reports:\n{}", first->what()));
}

/// Requires that completed runs are those of the present case.
void require_runs_of_this_case(const Study& study) {
  for (const StudyRun& run : study.runs) {
    const RunState state = read_run_state(study.path(run));
    if (!state.summary) continue;
    try {
      require_same_case(read_case(study.plan.case_path, run.planned.settings), state.summary->version,
                        state.summary->parameters, study.path(run));
    } catch (const Error& problem) {
      throw Error(problem.kind(), fmt::format("{}\nthe runs of this study no longer match its case: choose another "
                                              "directory with -o, or overwrite the study with --force",
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
              fmt::format("{}: already contains a study; continue it, or add runs to it, with --resume, choose another "
                          "directory with -o, or overwrite the study with --force",
                          directory));
}

/// Removes a study; only folders that the study itself lists belong to it.
void remove_old_study(const std::string& directory) {
  std::vector<std::string> folders;
  for (const StudyRun& run : read_study(directory).runs) folders.push_back(run.folder);
  remove_run_folders(directory, folders);
}

Study prepare_study(const std::string& directory, const StudyPlan& plan, const StudyQuestions& questions,
                    const StudyOptions& options) {
  Study study{{directory}, plan, questions, number_runs(plan)};
  require_one_valid_case(study);
  check_requested_columns(study);
  if (holds_study(directory) && options.force) remove_old_study(directory);
  if (holds_study(directory) && options.resume) {
    study.runs = reuse_runs(plan, read_study(directory));
    require_runs_of_this_case(study);
  }
  write_study(study);
  return study;
}

int run_study(const Study& study, const StudyOptions& options) {
  std::vector<PooledRun> runs;
  for (const StudyRun& run : study.runs) runs.push_back({study.plan.case_path, run.planned.settings, study.path(run)});
  return run_pool(runs, {options.jobs, options.threads, options.quiet, options.stop_signal, options.program}, [&] {
    // The old tables are obsolete until new ones are written.
    for (const char* file : {"study.csv", "study.md"}) {
      std::error_code ignored;
      std::filesystem::remove(study.path(file), ignored);
    }
  });
}

}  // namespace

StudyResults conduct_study(const std::string& directory, const StudyPlan& plan, const StudyQuestions& requested,
                           const StudyOptions& options, int& signal) {
  check_plan(plan);
  const StudyQuestions questions = checked_questions(requested, plan);
  refuse_other_results(directory, options);
  const RunDirectory lock(directory);
  const Study study = prepare_study(directory, plan, questions, options);
  signal = run_study(study, options);
  StudyResults results = make_study_table(study);
  write_study_table(study, results);
  return results;
}

}  // namespace ricochet
