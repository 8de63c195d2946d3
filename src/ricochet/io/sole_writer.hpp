#pragma once

#include <cstdint>
#include <string>

/// @file Files that a run writes piece by piece, and that nobody else may change meanwhile: what another program cuts
/// off, replaces or removes would be lost without a word.
namespace ricochet {

/// Remembers the device, the number and the size of a file, and throws where the file no longer has them.
class SoleWriter {
 public:
  /// Takes a file that is open for writing as it is now. Throws Error(file_access).
  explicit SoleWriter(std::string path);
  /// Sets the size that the file has from now on, by what has been written.
  void expect_size(std::int64_t size) { size_ = size; }
  /// Takes the present size, after another library has written, which keeps positions of its own: where the file was
  /// cut meanwhile, it has filled with zeros what was there. Throws Error(file_access) where that can be seen.
  void expect_present_size();
  /// Compares, before each piece and at the end. Throws Error(file_access) where the file is not there, is another one,
  /// or has another size.
  void require_untouched() const;

 private:
  [[noreturn]] void refuse(const std::string& state) const;
  [[nodiscard]] bool ends_with_zeros() const;

  std::string path_;
  std::uint64_t device_ = 0, number_ = 0;
  std::int64_t size_ = 0;
  bool knows_end_ = false;  ///< the last 512 bytes were not all zero
};

}  // namespace ricochet
