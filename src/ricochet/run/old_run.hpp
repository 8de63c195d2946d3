#pragma once

#include <string>
#include <vector>

#include "ricochet/io/run_directory.hpp"
#include "ricochet/run/run_case.hpp"

/// @file Results of an earlier run in the directory of a new one.
namespace ricochet {

/// Returns the directory of exported contact problems.
[[nodiscard]] std::string export_directory(const RunOptions& options);

/// Throws Error(file_access) if a file that the case is read from (the case itself, a mesh, a table) has the name of a
/// file that a run would write or remove there.
void refuse_overwriting_inputs(const RunDirectory& directory, const RunOptions& options, const Case& input);

/// Throws Error(file_access) if the directory holds results of another run.
void refuse_old_run(const RunDirectory& directory, const RunOptions& options);

/// The case of a run, as its output directory states it.
struct RunOrigin {
  std::string case_path;
  std::vector<std::string> settings;
};

/// Throws Error(file_access) if the directory does not state the case, or the case file no longer exists.
[[nodiscard]] RunOrigin find_origin(const std::string& directory);

/// Removes the results of an earlier run (this one may write no fields) and writes a summary of the new one. Called
/// when the new run is ready to start, so that a case that is refused destroys nothing. An interruption at any time
/// leaves a summary.json that describes either a run that --resume may start from its beginning or a complete earlier
/// one.
void replace_old_run(const RunDirectory& directory, const RunOptions& options, RunSummary summary);

}  // namespace ricochet
