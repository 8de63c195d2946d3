#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/base/types.hpp"

/// @file An HDF5 file of frames that survives interruptions: fixed data sets, then /frames/NNNNNN/… again and again.
///
/// The file is closed between frames: it is complete after each of them, whoever reads it then, and its bytes after k
/// frames depend on the data alone. So a file that was left in any state after its first k frames can be given back the
/// bytes it had: the numbers of these frames are never written over, and where everything else lies is found by writing
/// k empty frames into a file beside it.
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
  std::vector<double> reals;           ///< these, or
  std::vector<std::int64_t> integers;  ///< these
};

struct FrameFileOptions {
  bool single = false;  ///< reals of frames in 32 bits
  int compression = 0;  ///< 1 to 9: of zlib; 0: none
};

class FrameFile {
 public:
  /// A new file with the groups and data sets that all frames share. Throws Error(file_access).
  FrameFile(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
            const FrameFileOptions& options = {});
  /// Goes on with a file that held so many frames when save() was called, and may have been changed by an interrupted
  /// run since. Throws Error(file_access) where it is not that file, or where numbers of these frames are others now:
  /// then nothing has happened to it.
  FrameFile(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
            const FrameFileOptions& options, const Snapshot& snapshot, const std::string& name);
  void save(Snapshot& snapshot, const std::string& name) const;

  /// One frame: the values of its data sets, in the order of the layout (const double*, const int*). On a full disk
  /// throws Error(file_access) before the file is touched.
  void append(const std::vector<const void*>& values);
  [[nodiscard]] long frames() const { return frames_; }
  /// "/frames/000012".
  [[nodiscard]] static std::string frame_name(long frame);

 private:
  struct Extent {
    std::int64_t address = 0, size = 0;
  };
  struct Prepared;
  void create(const std::string& path, const std::vector<FixedDataset>& fixed) const;
  std::vector<Extent> write_frame(const std::string& path, long frame, const std::vector<const void*>* values,
                                  const std::int64_t* stored_sizes) const;
  [[nodiscard]] std::uint32_t checksum(const std::vector<Extent>& extents,
                                       const std::vector<const void*>* values) const;
  void require_same(const std::vector<Extent>& extents) const;
  void repair(const std::vector<FixedDataset>& fixed) const;
  [[nodiscard]] std::int64_t frame_bytes() const;

  std::string path_;
  std::vector<DatasetLayout> layout_;
  FrameFileOptions options_;
  std::shared_ptr<const Prepared> prepared_;
  long frames_ = 0;
  std::vector<std::int64_t> checksums_;     ///< of the numbers of every frame as they are in the file
  std::vector<std::int64_t> stored_sizes_;  ///< of the data sets of all frames, when compressed
};

}  // namespace ricochet
