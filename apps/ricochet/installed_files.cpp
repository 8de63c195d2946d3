#include "installed_files.hpp"

#include <filesystem>
#include <system_error>

namespace ricochet::program {

std::string installed_file(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code problem;
  const fs::path folder = fs::read_symlink("/proc/self/exe", problem).parent_path();
  for (const fs::path& share : {folder / "share", folder.parent_path() / "share"}) {
    const fs::path path = share / "ricochet" / name;
    if (fs::is_regular_file(path, problem)) return path.string();
  }
  return {};
}

}  // namespace ricochet::program
