#pragma once

#include <string>
#include <vector>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/table.hpp"

/// @file The table of a study: results of its runs.
namespace ricochet {

struct StudyResults {
  ResultTable table;
  /// Notes for readers, one sentence each: meaning of the columns, reasons why runs failed. Warnings of the runs.
  std::vector<std::string> notes, warnings;
  int done = 0;  ///< completed runs
  /// The worst status of the runs that have one; if these are all 0, status `usage` if no completed run has a requested
  /// quantity.
  int worst_status = 0;
};

/// Reads the results of all runs, as far as they exist. Columns: the varied keys; the results of every run; the
/// quantities of the case's [[expect]] entries and those requested; errors and orders; the message of a run that
/// failed. Two studies of the same plan have the same table except for processor_seconds. Throws Error as reading does,
/// and Error(usage) if the reference lacks a quantity to compare.
[[nodiscard]] StudyResults make_study_table(const Study& study);

/// Writes study.csv and study.md.
void write_study_table(const Study& study, const StudyResults& results);

/// Prefixes of the names of error columns and order columns.
inline constexpr const char *error_prefix = "error:", *order_prefix = "order:";

}  // namespace ricochet
