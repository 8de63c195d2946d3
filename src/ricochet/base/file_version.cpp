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

void require_readable_version(const std::string& path, const std::string& written_by) {
  const std::pair<int, int> release = release_of(written_by);
  if (release >= release_of(oldest_readable_version) && release <= release_of(version)) return;
  throw VersionError(fmt::format(
      "{}: written by {}; this is Ricochet {}, which reads results of versions {} to {}: repeat the run, or "
      "read its results with the version that wrote them",
      path,
      written_by.empty() ? fmt::format("a version of Ricochet before {}", oldest_readable_version)
                         : "Ricochet " + written_by,
      version, oldest_readable_version, version));
}

}  // namespace ricochet
