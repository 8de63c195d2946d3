#pragma once

#include <string>

#include "ricochet/base/error.hpp"

/// @file Version of Ricochet in the files of a run.
namespace ricochet {

/// Oldest version whose files this one reads.
inline constexpr const char* oldest_readable_version = "0.3.0";

/// Name of the entry, or of the attribute of the root, that states the version.
inline constexpr const char* version_attribute = "ricochet_version";

/// Error(invalid_input) about a file that another version has written.
struct VersionError : Error {
  VersionError(const std::string& both_versions, const std::string& advice)
      : Error(ErrorKind::invalid_input, both_versions + ": " + advice), versions(both_versions) {}

  std::string versions;  ///< the file and both versions, without the advice
};

/// Throws VersionError, which names both versions and ends with `advice`, unless a file was written by the oldest
/// readable version, this one, or one between; the last number of a version does not matter. An empty `written_by`
/// stands for the versions before 0.3.0, which did not write it into every file.
void require_readable_version(
    const std::string& path, const std::string& written_by,
    const std::string& advice = "repeat the run with --force, or read its results with the version that wrote them");

}  // namespace ricochet
