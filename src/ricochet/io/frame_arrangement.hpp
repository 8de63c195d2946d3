#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/hdf5/hdf5_handle.hpp"

/// @file How frames lie in an HDF5 file (FrameFile): each in a group of its own, or as further rows of data sets that
/// grow, as VTKHDF wants them.
namespace ricochet {

/// A data set as it is in the file. In memory reals are double and whole numbers int, row by row.
struct DatasetLayout {
  std::string name;
  bool whole = false;  ///< whole numbers of 32 bits
  Index rows = 0;
  Index columns = 0;  ///< 0: a data set of one dimension
};

struct FixedDataset {
  std::string name;  ///< with its group: "/mesh/nodes"
  Index rows = 0, columns = 0;
  std::vector<double> reals = {};           ///< these, or
  std::vector<std::int64_t> integers = {};  ///< these, or
  std::string same_as = {};                 ///< the data set of this name, under a second name
  bool bytes = false;                       ///< the integers take 8 bits each, unsigned
};

struct FrameFileOptions {
  bool single = false;  ///< reals of frames in 32 bits
  int compression = 0;  ///< 1 to 9: of zlib; 0: none
  bool vtkhdf = false;  ///< the frames are arranged as VTKHDF wants them
};

/// Where numbers are in the file.
struct FrameExtent {
  std::int64_t address = 0, size = 0;
};

struct FrameToWrite {
  long number = 0;
  double time = 0.0;
  const std::vector<const void*>* values = nullptr;  ///< nullptr: an empty frame of the same extents
  const std::int64_t* stored_sizes = nullptr;        ///< of an empty frame: those of compressed data sets
};

class FrameArrangement {
 public:
  virtual ~FrameArrangement() = default;
  /// What a new file has besides its fixed data sets. `path` is for messages. Throws Error(file_access).
  virtual void begin(std::int64_t file, const std::string& path) const = 0;
  /// Writes the frame behind those that are there. Extents are those of its data sets; addresses are known where there
  /// are no values, and of numbers that are in the file in another form than in memory. Throws Error(file_access).
  [[nodiscard]] virtual std::vector<FrameExtent> write(std::int64_t file, const std::string& path,
                                                       const FrameToWrite& frame) const = 0;
  /// The part of the file that holds the number of frames; empty if nothing does. One write must replace it.
  [[nodiscard]] virtual FrameExtent count_extent(std::int64_t file) const {
    (void)file;
    return {};
  }
  /// What messages call it.
  [[nodiscard]] virtual std::string name(long frame) const = 0;
  [[nodiscard]] virtual bool keeps_times() const = 0;
};

[[nodiscard]] std::unique_ptr<const FrameArrangement> make_frame_arrangement(const std::vector<FixedDataset>& fixed,
                                                                             const std::vector<DatasetLayout>& layout,
                                                                             const FrameFileOptions& options);

/// Small sets are not: the index of a compressed one takes some 2 kB.
[[nodiscard]] bool is_compressed(const DatasetLayout& layout, const FrameFileOptions& options);
/// Are its bytes in the file those in memory?
[[nodiscard]] bool is_as_in_memory(const DatasetLayout& layout, const FrameFileOptions& options);
[[nodiscard]] inline Index entries_of(const DatasetLayout& layout) {
  return layout.rows * (layout.columns > 0 ? layout.columns : 1);
}

/// What all arrangements do with HDF5. Throws Error(file_access) where something could not be written.
void check_written(const std::string& path, bool good, const std::string& what);
[[nodiscard]] Hdf5Handle hdf5_space(Index rows, Index columns);
/// The type that a data set has in the file.
[[nodiscard]] std::int64_t hdf5_type(const DatasetLayout& layout, const FrameFileOptions& options);
/// Properties of a data set whose place in the file does not depend on its numbers, but for the size of compressed
/// ones. `chunked`: also where it is not compressed; a chunk holds one frame.
void set_hdf5_frame_properties(std::int64_t properties, const DatasetLayout& layout, const FrameFileOptions& options,
                               bool chunked);
/// The chunk that begins at this row.
[[nodiscard]] FrameExtent hdf5_chunk_extent(std::int64_t set, Index first_row, bool& good);

}  // namespace ricochet
