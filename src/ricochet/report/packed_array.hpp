#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Arrays of numbers made small for a page: what does not change from entry to entry is taken away, bytes of
/// equal weight are put together, and zlib does the rest. viewer/src/data/decode.ts undoes it.
namespace ricochet {

enum class Coding {
  reals,    ///< IEEE doubles, exact: each xor the one before it, then all first bytes, all second bytes, …
  indices,  ///< 32-bit whole numbers, exact: differences to the one before it, zigzag, then byte by byte likewise
  levels,   ///< rows of reals in equal steps: value = low + level · step; the largest level stands for "no number"
};

/// Where an array is and how it is to be read.
struct PackedArray {
  std::size_t blob = 0;
  Coding coding = Coding::reals;
  Index rows = 0, columns = 0;
  int bits = 0;        ///< of a level, 2 to 16
  int prediction = 1;  ///< levels: 1 the row before; 2 that and the change of the entry before it in the row
  double low = 0.0, step = 0.0;
};

/// The arrays of a page; equal ones are kept once.
class PackedArrays {
 public:
  PackedArray add_reals(const std::vector<double>& values, Index rows, Index columns);
  PackedArray add_indices(const std::vector<int>& values);
  /// rows × columns values in levels of so many bits, from the least to the largest that is finite.
  PackedArray add_levels(const std::vector<float>& values, Index rows, Index columns, int bits);
  /// Whole numbers from −1 to 253.
  PackedArray add_small_numbers(const std::vector<float>& values, Index rows, Index columns);

  /// Compressed (zlib's format).
  [[nodiscard]] const std::vector<std::string>& blobs() const { return blobs_; }
  /// What they take in a page.
  [[nodiscard]] std::size_t page_bytes() const;

 private:
  std::size_t add(std::string bytes);

  std::vector<std::string> blobs_;
};

/// Bytes that so many take as base64.
[[nodiscard]] std::size_t base64_size(std::size_t bytes);
void append_base64(std::string_view bytes, std::string& text);

}  // namespace ricochet
