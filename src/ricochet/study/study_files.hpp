#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ricochet/study/plan.hpp"
#include "ricochet/study/run_folders.hpp"

/// @file The directory of a study: study.json with its plan, its runs in runs/, and its tables.
namespace ricochet {

/// Contents of the table in addition to the results of every run.
struct StudyQuestions {
  std::vector<std::string> quantities;                ///< in the syntax of [[expect]]
  std::vector<std::pair<std::string, double>> exact;  ///< quantities with their exact values
  /// Run to which errors of histories refer: "", the directory of a run, "last:KEY" or "finest:KEY" (the last, or
  /// smallest, value of this key, with the same values of all others).
  std::string reference;
  std::vector<std::string> compare;  ///< columns of the history, or vectors without their _x; empty: the usual ones
  std::string order_key;             ///< key whose values give observed orders; empty: chosen
};

struct StudyRun {
  PlannedRun planned;
  std::string folder;  ///< name of its folder in runs/
};

struct Study : PlanDirectory {
  StudyPlan plan;
  StudyQuestions questions;
  std::vector<StudyRun> runs;  ///< in the order of the table
};

[[nodiscard]] inline bool holds_study(const std::string& directory) { return holds_plan(directory, "study.json"); }
/// Throws Error(file_access) if there is no study, Error(invalid_input) if it is damaged.
[[nodiscard]] Study read_study(const std::string& directory);
void write_study(const Study& study);

/// Returns the runs of a plan in new folders.
[[nodiscard]] std::vector<StudyRun> number_runs(const StudyPlan& plan);
/// Returns the runs of a plan in the folders of an existing study, and those that it lacks in new folders. Throws
/// Error(file_access) if the study has runs that are not in this plan.
[[nodiscard]] std::vector<StudyRun> reuse_runs(const StudyPlan& plan, const Study& before);

/// Checks the questions of a study: quantities can be parsed, KEYs vary; "last", "finest" and orders get their keys.
/// Throws Error(usage) or Error(invalid_input).
[[nodiscard]] StudyQuestions checked_questions(StudyQuestions questions, const StudyPlan& plan);
/// Parses "QUANTITY=VALUE". Throws Error(usage).
[[nodiscard]] std::pair<std::string, double> parse_exact(const std::string& text);

}  // namespace ricochet
