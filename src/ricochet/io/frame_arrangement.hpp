#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/hdf5/hdf5_handle.hpp"

/// @file Arrangement of frames in an HDF5 file (FrameFile): each in a group of its own, or as further rows of growing
/// datasets, as VTKHDF requires.
namespace ricochet {

/// Dataset in the file. In memory reals are double and integers int, row by row.
struct DatasetLayout {
  std::string name;
  bool is_integer = false;  ///< integers of 32 bits
  Index rows = 0;
  Index columns = 0;  ///< 0: a dataset of one dimension
};

struct FixedDataset {
  std::string name;  ///< with its group: "/mesh/nodes"
  Index rows = 0, columns = 0;
  std::vector<double> reals = {};           ///< these, or
  std::vector<std::int64_t> integers = {};  ///< these, or
  std::string same_as = {};                 ///< second name of the dataset of this name
  bool bytes = false;                       ///< the integers are unsigned with 8 bits each
};

struct FrameFileOptions {
  bool single = false;  ///< reals of frames in 32 bits
  int compression = 0;  ///< zlib level 1 to 9; 0: none
  bool vtkhdf = false;  ///< the frames have the arrangement of VTKHDF
};

/// Position and size of values in the file.
struct FrameExtent {
  std::int64_t address = 0, size = 0;
};

struct FrameToWrite {
  long number = 0;
  double time = 0.0;
  const std::vector<const void*>* values = nullptr;  ///< nullptr: an empty frame of the same extents
  const std::int64_t* stored_sizes = nullptr;        ///< for an empty frame: sizes of the compressed datasets
};

class FrameArrangement {
 public:
  virtual ~FrameArrangement() = default;
  /// Writes everything of a new file besides its fixed datasets. `path` is for messages. Throws Error(file_access).
  virtual void begin(std::int64_t file, const std::string& path) const = 0;
  /// Writes the frame behind the existing ones. Returns the extents of its datasets; addresses are known if there are
  /// no values, and for datasets whose form in the file differs from that in memory. Throws Error(file_access).
  [[nodiscard]] virtual std::vector<FrameExtent> write(std::int64_t file, const std::string& path,
                                                       const FrameToWrite& frame) const = 0;
  /// Part of the file that holds the number of frames; empty if there is none. It must be replaceable by one write.
  [[nodiscard]] virtual FrameExtent count_extent(std::int64_t file) const {
    (void)file;
    return {};
  }
  /// Name of a frame in messages.
  [[nodiscard]] virtual std::string name(long frame) const = 0;
  [[nodiscard]] virtual bool keeps_times() const = 0;
};

[[nodiscard]] std::unique_ptr<const FrameArrangement> make_frame_arrangement(const std::vector<FixedDataset>& fixed,
                                                                             const std::vector<DatasetLayout>& layout,
                                                                             const FrameFileOptions& options);

/// Returns whether a dataset is compressed. Small ones are not: the index of a compressed one takes some 2 kB.
[[nodiscard]] bool is_compressed(const DatasetLayout& layout, const FrameFileOptions& options);
/// Returns whether the bytes in the file are those in memory.
[[nodiscard]] bool is_as_in_memory(const DatasetLayout& layout, const FrameFileOptions& options);
[[nodiscard]] inline Index entries_of(const DatasetLayout& layout) {
  return layout.rows * (layout.columns > 0 ? layout.columns : 1);
}

/// HDF5 functions of all arrangements. Throws Error(file_access) if something could not be written.
void check_written(const std::string& path, bool good, const std::string& what);
[[nodiscard]] Hdf5Handle hdf5_space(Index rows, Index columns);
/// Type of a dataset in the file.
[[nodiscard]] std::int64_t hdf5_type(const DatasetLayout& layout, const FrameFileOptions& options);
/// Sets the properties of a dataset whose position in the file does not depend on its values, except for the size of
/// compressed ones. `chunked`: also if it is not compressed; a chunk holds one frame.
void set_hdf5_frame_properties(std::int64_t properties, const DatasetLayout& layout, const FrameFileOptions& options,
                               bool chunked);
/// Extent of the chunk that begins at this row.
[[nodiscard]] FrameExtent hdf5_chunk_extent(std::int64_t set, Index first_row, bool& good);

}  // namespace ricochet
