#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// @file Checksums of numbers, to find out whether two things have the same bytes.
namespace ricochet {

/// CRC-32 and length of a sequence of bytes.
class Checksum {
 public:
  Checksum& add_bytes(const void* bytes, std::size_t size);
  template <class Number>
  Checksum& add(const Number* numbers, std::size_t count) {
    return add_bytes(numbers, count * sizeof(Number));
  }
  [[nodiscard]] std::uint32_t value() const { return value_; }
  /// Returns "1a2b3c4d of 1234 bytes".
  [[nodiscard]] std::string text() const;

 private:
  std::uint32_t value_ = 0;
  std::size_t size_ = 0;
};

}  // namespace ricochet
