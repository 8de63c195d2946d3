#pragma once

#include <functional>
#include <string>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/study_table.hpp"

/// @file A study: runs of one case with other values, some at a time, each in a process of its own.
namespace ricochet {

struct StudyOptions {
  std::size_t jobs = 1;                    ///< runs at a time
  int threads = 1;                         ///< of each
  bool resume = false;                     ///< go on with the study that is in the directory, also with more runs
  bool force = false;                      ///< start anew over a study that is there
  bool quiet = false;                      ///< no progress
  std::string program = "/proc/self/exe";  ///< its command `run` runs a case
  /// Asked all the time: not 0, the number of the signal that is to end the study.
  std::function<int()> stop_signal = {};
};

/// Runs what is still to be run of a plan into `directory`, and writes its tables; `signal` gets what has stopped it,
/// or 0. A run that fails is a row of the table. Throws Error(file_access) where the directory holds something else, or
/// another study is in it; Error(invalid_input) where all runs would be refused, or where runs that are there are not
/// those of the case any more; Error(usage) as check_plan and checked_questions do.
[[nodiscard]] StudyResults conduct_study(const std::string& directory, const StudyPlan& plan,
                                         const StudyQuestions& questions, const StudyOptions& options, int& signal);

}  // namespace ricochet
