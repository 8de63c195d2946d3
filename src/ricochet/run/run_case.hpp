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
  bool force = false;  ///< overwrite a run that is there
  bool quiet = false;  ///< no progress
  /// Go on with the run that is in the directory, from its last checkpoint; from the beginning where it has none.
  bool resume = false;
  /// A run that a program loads as it goes (Session::set_load), or whose obstacles it moves, may go on with the last
  /// load and motion until it sets them again; run_case refuses it.
  bool resume_load = true;
  /// Asked after every step: not zero, the number of the signal that is to end the run with a checkpoint.
  std::function<int()> stop_signal = {};
  /// Steps whose contact problems are written as FCLib files, see io/contact_export.hpp.
  std::vector<StepRange> export_contact = {};
  std::string export_contact_to = {};  ///< their directory; empty: contact/ in the output directory
  /// Where the case is kept, for --resume; empty: where it was read.
  std::string case_path = {};
  /// What --set has changed in the case, for a --resume that is not told again.
  std::vector<std::string> settings = {};
  /// The processes that run the case together, each with its part of the body (Session::set_model_builder).
  const Ranks* ranks = &one_rank();
};

/// Runs a case and writes history.csv, results.h5, results.xdmf, summary.json and checkpoints, and contact problems
/// that are asked for. Throws Error; when a step fails, what came before it is in the files and summary.json says what
/// happened. A run that was stopped has the status "interrupted".
RunSummary run_case(const Case& input, const RunOptions& options);
/// Of a session that has not begun; its warnings, those of reading the case among them, are in the summary.
RunSummary run_case(Session& session, const RunOptions& options);

/// How the warning begins that the end time is no whole number of steps.
inline constexpr const char* end_warning = "time.end = ";
void warn_of_end(const TimeSection& time);

/// Throws Error(invalid_input), at its place in the case, where an [[expect]] entry that applies is about a column that
/// history.csv will not have, or about a time outside the run.
void check_expected_quantities(const Case& input, const Model& model);

/// Which [[expect]] entries apply, of those whose `when` holds.
enum class ExpectationScope {
  settings_of_the_case,  ///< all, unless --set changed a key that their `when` does not name
  any_settings           ///< all: what another method makes of the case is asked for
};

/// Evaluates the [[expect]] entries of a case on a finished run.
[[nodiscard]] std::vector<ExpectationResult> check_expectations(
    const Case& input, const std::string& output_directory, const std::string& summary_json,
    ExpectationScope scope = ExpectationScope::settings_of_the_case);
/// Those of a run that came to no end: none that applies holds, and `why` is their note.
[[nodiscard]] std::vector<ExpectationResult> unmet_expectations(const Case& input, const std::string& why,
                                                                ExpectationScope scope);

}  // namespace ricochet
