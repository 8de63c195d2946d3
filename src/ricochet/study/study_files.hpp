#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ricochet/study/plan.hpp"

/// @file The directory of a study: study.json, which says what it is of, its runs in runs/, and its tables.
namespace ricochet {

/// What the table says besides what every run comes to.
struct StudyQuestions {
  std::vector<std::string> quantities;                ///< in the language of [[expect]]
  std::vector<std::pair<std::string, double>> exact;  ///< a quantity, and the value that it should have
  /// The run that errors of histories are those to: "", the directory of a run, "last:KEY" or "finest:KEY" (the last,
  /// or smallest, value of this key, with the same values of all others).
  std::string reference;
  std::vector<std::string> compare;  ///< columns of the history, or vectors without their _x; empty: the usual ones
  std::string order_key;             ///< the key whose values give observed orders; empty: chosen
};

struct StudyRun {
  PlannedRun planned;
  std::string folder;  ///< its name in runs/
};

struct Study {
  std::string directory;
  StudyPlan plan;
  StudyQuestions questions;
  std::vector<StudyRun> runs;  ///< in the order of the table

  [[nodiscard]] std::string path(const std::string& file) const;
  [[nodiscard]] std::string path(const StudyRun& run) const;
};

[[nodiscard]] bool holds_study(const std::string& directory);
/// Throws Error(file_access) where there is none, Error(invalid_input) where it is damaged.
[[nodiscard]] Study read_study(const std::string& directory);
void write_study(const Study& study);

/// The runs of a plan in new folders.
[[nodiscard]] std::vector<StudyRun> number_runs(const StudyPlan& plan);
/// The runs of a plan in the folders of a study that is there, and those that it lacks in new ones. Throws
/// Error(file_access) where runs that are there are not of this plan.
[[nodiscard]] std::vector<StudyRun> take_over_runs(const StudyPlan& plan, const Study& before);

/// What a study may ask, checked: quantities can be read, KEYs vary; "last" and "finest" get their key, and an order
/// its own. Throws Error(usage) or Error(invalid_input).
[[nodiscard]] StudyQuestions checked_questions(StudyQuestions questions, const StudyPlan& plan);
/// "QUANTITY=VALUE", taken apart. Throws Error(usage).
[[nodiscard]] std::pair<std::string, double> parse_exact(const std::string& text);

}  // namespace ricochet
