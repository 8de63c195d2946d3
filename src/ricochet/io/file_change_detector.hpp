#pragma once

#include <cstdint>
#include <string>

/// @file Files that a run writes piece by piece and that must not be changed meanwhile: data that another program
/// truncates, replaces or removes would be lost silently.
namespace ricochet {

/// Remembers device, inode number and size of a file, and throws if they change.
class FileChangeDetector {
 public:
  /// Registers the present state of a file that is open for writing. Throws Error(file_access).
  explicit FileChangeDetector(std::string path);
  /// Sets the expected size after a write.
  void expect_size(std::int64_t size) { size_ = size; }
  /// Adopts the present size, after a write by another library, which tracks positions itself: if the file was
  /// truncated meanwhile, the gap has been filled with zeros. Throws Error(file_access) if that is detectable.
  void expect_present_size();
  /// Checks the file, before each piece and at the end. Throws Error(file_access) if it is missing, has been replaced
  /// or has another size.
  void require_unchanged() const;

 private:
  [[noreturn]] void refuse(const std::string& state) const;
  [[nodiscard]] bool ends_with_zeros() const;

  std::string path_;
  std::uint64_t device_ = 0, number_ = 0;
  std::int64_t size_ = 0;
  bool knows_end_ = false;  ///< the last 512 bytes were not all zero
};

}  // namespace ricochet
