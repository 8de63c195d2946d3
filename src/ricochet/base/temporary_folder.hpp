#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "ricochet/base/interruption.hpp"

/// @file A folder that exists as long as its object, or until the process is interrupted.
namespace ricochet {

class TemporaryFolder {
 public:
  /// Creates a folder in `parent` with a unique name that begins with `prefix`. Throws Error(file_access).
  TemporaryFolder(const std::filesystem::path& parent, const std::string& prefix);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
  std::optional<AtInterruption> at_interruption_;
};

}  // namespace ricochet
