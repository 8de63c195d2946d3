#include "installed_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "ricochet/base/error.hpp"

namespace ricochet::program {

std::string installed_file(const std::string& name, const std::string& what, const std::string& advice) {
  namespace fs = std::filesystem;
  std::error_code problem;
  const fs::path folder = fs::read_symlink("/proc/self/exe", problem).parent_path();
  for (const fs::path& share : {folder / "share", folder.parent_path() / "share"}) {
    const fs::path path = share / "ricochet" / name;
    if (fs::is_regular_file(path, problem)) return path.string();
  }
  throw Error(ErrorKind::file_access,
              fmt::format("share/ricochet/{}, {}, is missing beside this program: {}", name, what, advice));
}

std::string benchmark_manifest() {
  return installed_file("benchmarks/benchmarks.toml", "the list of the benchmarks beside their cases",
                        "build or install Ricochet again, or name a folder with --folder");
}

}  // namespace ricochet::program
