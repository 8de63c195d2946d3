#include "ricochet/base/temporary_folder.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const fs::path& parent, const std::string& prefix) {
  std::string pattern = (parent / (prefix + "-XXXXXX")).string();
  const auto make = [&] {
    if (mkdtemp(pattern.data()) == nullptr) {
      throw Error(ErrorKind::file_access,
                  fmt::format("cannot make a directory in {}: {}", parent.string(), std::strerror(errno)));
    }
    path_ = pattern;
  };
  at_interruption_.emplace(make, [this] {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  });
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace ricochet
