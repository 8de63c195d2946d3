#pragma once

#include <functional>
#include <string>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/study_table.hpp"

/// @file A study: runs of one case with other values, several at a time, each in a process of its own.
namespace ricochet {

struct StudyOptions {
  std::size_t jobs = 1;                    ///< number of simultaneous runs
  int threads = 1;                         ///< per run
  bool resume = false;                     ///< resume the study in the directory, possibly with additional runs
  bool force = false;                      ///< replace an existing study
  bool quiet = false;                      ///< no progress
  std::string program = "/proc/self/exe";  ///< program whose command `run` runs a case
  /// Polled continuously; if not 0, the number of the signal that ends the study.
  std::function<int()> stop_signal = {};
};

/// Computes the runs of a plan that are not complete in `directory`, and writes its tables; `signal` receives the
/// signal that has stopped it, or 0. A run that fails is a row of the table. Throws Error(file_access) if the directory
/// holds something else or another study; Error(invalid_input) if all runs would be refused, or if existing runs no
/// longer belong to the case; Error(usage) as check_plan and checked_questions do.
[[nodiscard]] StudyResults conduct_study(const std::string& directory, const StudyPlan& plan,
                                         const StudyQuestions& questions, const StudyOptions& options, int& signal);

}  // namespace ricochet
