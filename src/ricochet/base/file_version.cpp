#include "ricochet/base/file_version.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "ricochet/version.hpp"

namespace ricochet {

namespace {

/// Returns major and minor number; −1 if there are none.
std::pair<int, int> release_of(const std::string& text) {
  std::pair<int, int> release{-1, -1};
  if (std::sscanf(text.c_str(), "%d.%d", &release.first, &release.second) != 2) return {-1, -1};
  return release;
}

}  // namespace

void require_readable_version(const std::string& path, const std::string& written_by, const std::string& advice) {
  const std::pair<int, int> release = release_of(written_by);
  if (release >= release_of(oldest_readable_version) && release <= release_of(version)) return;
  const bool reads_others = release_of(oldest_readable_version) != release_of(version);
  throw VersionError(
      fmt::format("{}: written by {}; this is Ricochet {}, which reads results of {}", path,
                  written_by.empty() ? fmt::format("a version of Ricochet before {}", oldest_readable_version)
                                     : "Ricochet " + written_by,
                  version,
                  reads_others ? fmt::format("versions {} to {}", oldest_readable_version, version)
                               : fmt::format("version {}", version)),
      advice);
}

}  // namespace ricochet
