#pragma once

#include <string>
#include <vector>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/table.hpp"

/// @file What came out of the runs of a study: its table.
namespace ricochet {

struct StudyResults {
  ResultTable table;
  /// For readers, a sentence each: what the columns mean, and why runs failed; and what runs warned of.
  std::vector<std::string> notes, warnings;
  int done = 0;  ///< runs that came to their end
  /// Of the runs that have one; where all of these are 0, that of a question that no run that is done could answer.
  int worst_status = 0;
};

/// Reads all runs, as far as they are. Columns: the varied keys; what every run comes to; the quantities of the case's
/// [[expect]] entries and those asked for; errors and orders; the message of a run that failed. Two studies of the same
/// plan have the same table but for processor_seconds. Throws Error as reading does, and Error(usage) where the
/// reference cannot answer.
[[nodiscard]] StudyResults make_study_table(const Study& study);

/// Writes study.csv and study.md.
void write_study_table(const Study& study, const StudyResults& results);

/// What error columns and order columns begin with.
inline constexpr const char *error_prefix = "error:", *order_prefix = "order:";

}  // namespace ricochet
