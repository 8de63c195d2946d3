#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/case/case.hpp"
#include "ricochet/io/contact_export.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file Running a case: everything between a case file and an output directory.
namespace ricochet {

struct Model;
class Session;

struct RunOptions {
  std::string output_directory;
  bool force = false;  ///< overwrite an existing run
  bool quiet = false;  ///< no progress
  /// Resumes the run in the directory from its last checkpoint, or from the beginning if it has none.
  bool resume = false;
  /// Allows a run whose loads (Session::set_load) or obstacle motions a program sets to resume with the last load and
  /// motion until the program sets them again; run_case refuses such a run.
  bool resume_load = true;
  /// Polled after every step; if not zero, the number of the signal that ends the run with a checkpoint.
  std::function<int()> stop_signal = {};
  /// Steps whose contact problems are written as FCLib files, see io/contact_export.hpp.
  std::vector<StepRange> export_contact = {};
  std::string export_contact_to = {};  ///< directory; empty: contact/ in the output directory
  /// Path of the case for --resume; empty: the path it was read from.
  std::string case_path = {};
  /// Changes of the case by --set, for a --resume without them.
  std::vector<std::string> settings = {};
  /// Processes that run the case together, each with its part of the body (Session::set_model_builder).
  const Ranks* ranks = &one_rank();
};

/// Runs a case and writes history.csv, results.h5, results.xdmf, summary.json, checkpoints and the requested contact
/// problems. Throws Error; if a step fails, the files contain the earlier steps, and summary.json states the error. A
/// run that was stopped has the status "interrupted".
RunSummary run_case(const Case& input, const RunOptions& options);
/// Runs a session that has not begun; its warnings, including those of reading the case, enter the summary.
RunSummary run_case(Session& session, const RunOptions& options);

/// Start of the warning that the end time is not a whole number of steps.
inline constexpr const char* end_warning = "time.end = ";
void warn_of_end(const TimeSection& time);

/// Throws Error(invalid_input), with the location in the case, if an [[expect]] entry that applies refers to a column
/// that history.csv will not have, or to a time outside the run.
void check_expected_quantities(const Case& input, const Model& model);

/// Selects which [[expect]] entries apply, among those whose `when` holds.
enum class ExpectationScope {
  settings_of_the_case,  ///< all, unless --set changed a key that their `when` does not name
  any_settings           ///< all, to assess the results of another method
};

/// Evaluates the [[expect]] entries of a case on a finished run.
[[nodiscard]] std::vector<ExpectationResult> check_expectations(
    const Case& input, const std::string& output_directory, const std::string& summary_json,
    ExpectationScope scope = ExpectationScope::settings_of_the_case);
/// Returns the entries as results of a run that did not finish: none that applies holds, and `why` is their note.
[[nodiscard]] std::vector<ExpectationResult> unmet_expectations(const Case& input, const std::string& why,
                                                                ExpectationScope scope);

}  // namespace ricochet
