#pragma once

#include <string>
#include <vector>

#include "ricochet/io/run_directory.hpp"
#include "ricochet/run/run_case.hpp"

/// @file What an earlier run has left where a new one is to write.
namespace ricochet {

/// Where contact problems go that are asked for.
[[nodiscard]] std::string export_directory(const RunOptions& options);

/// Throws Error(file_access) where a file that the case is read from, itself or its meshes and tables, has the name of
/// one that a run would write or remove there.
void refuse_inputs_in_the_way(const RunDirectory& directory, const RunOptions& options, const Case& input);

/// Throws Error(file_access) where there are results of another run.
void refuse_old_run(const RunDirectory& directory, const RunOptions& options);

/// The case of a run, as its directory remembers it.
struct RunOrigin {
  std::string case_path;
  std::vector<std::string> settings;
};

/// Throws Error(file_access) where the directory does not know, or the case file is not there any more.
[[nodiscard]] RunOrigin find_origin(const std::string& directory);

/// Takes away what an earlier run left (this one may write no fields) and says which run is here now. Called when the
/// new run is ready to start, so that a case that is refused costs nothing. Whenever it is interrupted, summary.json
/// describes a run that --resume may start from its beginning, or one that is there to its end.
void replace_old_run(const RunDirectory& directory, const RunOptions& options, RunSummary summary);

}  // namespace ricochet
