#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Arrays of numbers compressed for a page: differences replace values that change little from entry to entry,
/// bytes of equal weight are collected, and zlib compresses the result. viewer/src/data/decode.ts is the inverse.
namespace ricochet {

enum class Coding {
  reals,    ///< IEEE doubles, exact: each xor its predecessor, then all first bytes, all second bytes, …
  indices,  ///< 32-bit integers, exact: differences from the predecessor, zigzag, then byte by byte as above
  levels,   ///< rows of reals in equal steps: value = low + level · step; the largest level stands for "no number"
};

/// Position of an array and its coding.
struct PackedArray {
  std::size_t blob = 0;
  Coding coding = Coding::reals;
  Index rows = 0, columns = 0;
  int bits = 0;        ///< of a level, 2 to 16
  int prediction = 1;  ///< for levels: 1 the row before; 2 also the change of the preceding entry in the row
  double low = 0.0, step = 0.0;
};

/// The arrays of a page; equal ones are stored once.
class PackedArrays {
 public:
  PackedArray add_reals(const std::vector<double>& values, Index rows, Index columns);
  PackedArray add_indices(const std::vector<int>& values);
  /// Adds rows × columns values in levels of so many bits, from the smallest to the largest finite one.
  PackedArray add_levels(const std::vector<float>& values, Index rows, Index columns, int bits);
  /// Adds integers from −1 to 253.
  PackedArray add_small_numbers(const std::vector<float>& values, Index rows, Index columns);

  /// Returns the compressed arrays (zlib format).
  [[nodiscard]] const std::vector<std::string>& blobs() const { return blobs_; }
  /// Returns their size in a page.
  [[nodiscard]] std::size_t page_bytes() const;

 private:
  std::size_t add(std::string bytes);

  std::vector<std::string> blobs_;
};

/// Returns the size of so many bytes in base64.
[[nodiscard]] std::size_t base64_size(std::size_t bytes);
void append_base64(std::string_view bytes, std::string& text);

}  // namespace ricochet
