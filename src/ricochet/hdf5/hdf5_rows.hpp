#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/hdf5/hdf5_handle.hpp"

/// @file A data set of an HDF5 file that is read some rows at a time.
namespace ricochet {

/// A data set of numbers of any type, with one or two dimensions. It is opened once, with its index: its present rows
/// can then be read while another process appends further ones.
class Hdf5Rows {
 public:
  /// Keeps a reference to the file. Throws Error(invalid_input) if there is no such data set.
  Hdf5Rows(const Hdf5Reader& file, const std::string& name);

  /// Reads row by row; NaN and infinities are accepted. Throws Error(invalid_input) if the rows do not exist.
  void read(Index first, Index count, std::vector<float>& values) const;
  void read(Index first, Index count, std::vector<double>& values) const;

 private:
  [[nodiscard]] std::size_t entries(Index first, Index count) const;
  void read(Index first, Index count, std::int64_t type, void* values) const;

  const Hdf5Reader& file_;
  std::string name_;
  std::pair<Index, Index> extents_;  ///< rows and columns (0: one dimension)
  Hdf5Handle set_;
};

}  // namespace ricochet
